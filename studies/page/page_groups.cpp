#include "studies/page/page_groups.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "results/report/page_data.hpp"
#include "solvers/quantities/quantity.hpp"
#include "solvers/transient/motion_quantity.hpp"
#include "studies/page/crank_motion.hpp"
#include "studies/page/profile_group.hpp"
#include "studies/page/study_facts.hpp"
#include "studies/reading/text/name_pattern.hpp"

namespace frahm::studies {
namespace {

using Names = std::vector<std::string>;
using Variables = std::vector<results::Variable>;

bool compares_responses(const Study& study) {
  return study.sweep() && study.sweep()->comparison && study.sweep()->comparison->show;
}

// The quantities of responses that are marked for an atlas in the table of quantities.
std::set<std::string> marked_quantities(const Study& study) {
  std::set<std::string> names;
  for (const periodic::Quantity& quantity : periodic::all_quantities(study.network)) {
    if (periodic::is_shown(quantity, study.network))
      names.insert(periodic::describe(quantity, study.network, study.dimensionless).name);
  }
  return names;
}

// What a page says of a map, whatever else it shows: that its responses are not all there may be.
bool is_always_shown(const std::string& name) {
  return name == "unsettled" || name == "continuum";
}

// The quantities that are marked, and the differences of a comparison; of two of several responses, which
// differ much, the other one too. All recorded quantities if these are no numbers.
Names default_quantities(const Study& study, const Variables& variables) {
  const std::set<std::string> marked = study.transient() ? std::set<std::string>{} : marked_quantities(study);
  const auto is_shown = [&](const std::string& name) {
    if (name.ends_with("_difference") || (compares_responses(study) && name.ends_with("_compared")))
      return true;
    return study.transient() ? transient::is_shown_of_motion(name) : marked.contains(name);
  };
  Names shown, all;
  bool any_number = false;
  for (const results::Variable& variable : variables) {
    all.push_back(variable.name);
    if (!is_shown(variable.name)) continue;
    shown.push_back(variable.name);
    any_number = any_number || (variable.type != results::Type::flag && !is_always_shown(variable.name));
  }
  return any_number ? shown : all;
}

// Those of [report], or the default ones; a page opens with its first number.
Names shown_quantities(const Study& study, const Variables& variables) {
  const MapChoice& map = *study.map();
  Names asked, known;
  for (const OutputChoice::Name& name : map.report_quantities) asked.push_back(name.text);
  for (const results::Variable& variable : variables) known.push_back(variable.name);
  Names names = asked.empty() ? default_quantities(study, variables) : matching(asked, known);
  if (!map.headline) return names;
  std::erase(names, map.headline->text);
  names.insert(names.begin(), map.headline->text);
  return names;
}

// What a page says of any map, and what a profile is drawn from.
Names always_shown_quantities(const Study& study, const Variables& variables) {
  Names names;
  for (const results::Variable& variable : variables)
    if (is_always_shown(variable.name)) names.push_back(variable.name);
  if (!study.sweep() || !study.sweep()->profile) return names;
  for (std::string& name : profile_quantities(study, *study.sweep()->profile, variables))
    names.push_back(std::move(name));
  return names;
}

std::vector<results::Text> map_texts(const Study& study, const results::MapLayout& layout) {
  if (layout.axes.empty()) return {};
  Names parameters;
  for (const ParameterAxis& axis : study.map()->axes)
    parameters.push_back(study.parameters.list[axis.parameter].name);
  const auto joined = [](const Names& names) { return fmt::format("{}", fmt::join(names, ",")); };
  std::vector<results::Text> texts{
      {results::parameters_text, joined(parameters)},
      {shown_text, joined(shown_quantities(study, layout.variables))},
      {always_shown_text, joined(always_shown_quantities(study, layout.variables))}};
  if (const auto& samples = study.map()->samples)
    texts.emplace_back(results::samples_text, layout.axes[samples->dimension].name);
  return texts;
}

}  // namespace

std::vector<results::GroupContent> page_groups(const Study& study, const results::MapLayout& layout) {
  std::vector<results::GroupContent> groups{{.path = results::page_group, .texts = map_texts(study, layout)}};
  const auto add = [&](results::GroupContent group) {
    if (!group.columns.empty() || !group.texts.empty()) groups.push_back(std::move(group));
  };
  add({.path = "page/crank", .columns = crank_motions(study)});
  if (study.sweep() && study.sweep()->profile) add(profile_group(study, *study.sweep()->profile));
  add(study_facts(study));
  return groups;
}

}  // namespace frahm::studies
