#include "studies/program/report_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <optional>

#include "solvers/transient/motion_quantity.hpp"
#include "studies/program/report_facts.hpp"
#include "studies/program/report_profile.hpp"
#include "studies/provenance/stored_study.hpp"
#include "studies/reading/text/name_pattern.hpp"

namespace frahm::studies {
namespace {

// The study that the result holds, if it can be read again: a table of the study may be elsewhere.
std::optional<Study> study_of(const results::MapReader& result, const std::filesystem::path& file) {
  try {
    return read_stored_study(result, file).study;
  } catch (const StudyError& error) {
    std::cerr << fmt::format("frahm: the study in {} cannot be read again, so the report leaves it out: {}\n",
                             file.string(), error.what());
    return std::nullopt;
  }
}

bool compares_responses(const std::optional<Study>& study) {
  return study && study->sweep() && study->sweep()->comparison && study->sweep()->comparison->show;
}

// The quantities marked for an atlas in the table of quantities, and the differences of a comparison; of two
// of several responses, which differ much, the other one too.
bool is_shown_by_default(const std::string& name, const std::optional<Study>& study) {
  if (name.ends_with("_difference")) return true;
  if (compares_responses(study) && name.ends_with("_compared")) return true;
  if (study && study->transient()) return transient::is_shown_of_motion(name);
  const auto quantity = study ? periodic::find_quantity(name, study->network) : std::nullopt;
  return quantity ? periodic::is_shown(*quantity, study->network) : periodic::is_shown(name);
}

// What a page says of a map, whatever else it shows: that its responses are not all there may be.
bool is_always_shown(const std::string& name) {
  return name == "unsettled" || name == "continuum";
}

// All recorded quantities if none of them is shown by default.
std::vector<std::string> default_quantities(const results::MapLayout& layout,
                                            const std::optional<Study>& study) {
  std::vector<std::string> shown, all;
  bool any_number = false;
  for (const results::Variable& variable : layout.variables) {
    all.push_back(variable.name);
    if (!is_shown_by_default(variable.name, study)) continue;
    shown.push_back(variable.name);
    any_number = any_number || (variable.type != results::Type::flag && !is_always_shown(variable.name));
  }
  return any_number ? shown : all;
}

void check_quantities(const std::vector<std::string>& asked, const results::MapLayout& layout) {
  for (const std::string& name : asked) {
    const auto& known = layout.variables;
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const results::Variable& variable) {
      return matches(name, variable.name);
    });
    if (is_known) continue;
    std::vector<std::string> names;
    for (const results::Variable& variable : known) names.push_back(variable.name);
    throw StudyError(rules::wrong_option, "--quantities: the result has no quantity \"{}\"{}", name,
                     names.empty() ? ", as it has no map" : hint_of_unmatched(name, names));
  }
}

// A browser holds some gigabytes of numbers; Node.js reads all digits of them as one text of half a gigabyte
// at most.
void check_size(const results::MapLayout& layout, std::size_t quantities, bool all_digits) {
  const double most_numbers = all_digits ? 4e7 : 2e8;
  double points = 1.0;
  for (const results::Axis& axis : layout.axes) points *= static_cast<double>(axis.size);
  if (points * static_cast<double>(quantities) <= most_numbers) return;
  throw StudyError(rules::too_large,
                   "the report would hold {} quantities at {:.4g} points; {} takes at most {:.0e} numbers: "
                   "name fewer with --quantities, or sweep only a part of the map for it",
                   quantities, points, all_digits ? "Node.js" : "a browser", most_numbers);
}

// The names of recorded quantities that these names and patterns stand for, each once.
std::vector<std::string> named_quantities(const std::vector<std::string>& asked,
                                          const results::MapLayout& layout) {
  std::vector<std::string> names;
  for (const std::string& each : asked) {
    for (const results::Variable& variable : layout.variables)
      if (matches(each, variable.name) && std::ranges::find(names, variable.name) == names.end())
        names.push_back(variable.name);
  }
  return names;
}

std::vector<std::string> chosen_quantities(const std::vector<std::string>& asked,
                                           const results::MapLayout& layout,
                                           const std::optional<Study>& study) {
  check_quantities(asked, layout);
  if (!asked.empty()) return named_quantities(asked, layout);
  if (!study || !study->map()) return default_quantities(layout, study);
  const MapChoice& map = *study->map();
  std::vector<std::string> names;
  for (const OutputChoice::Name& name : map.report_quantities) names.push_back(name.text);
  names = names.empty() ? default_quantities(layout, study) : named_quantities(names, layout);
  if (map.headline) {  // a page opens with its first number
    std::erase(names, map.headline->text);
    names.insert(names.begin(), map.headline->text);
  }
  return names;
}

// Those, what is always shown, and what a profile is drawn from.
std::vector<std::string> shown_quantities(const std::vector<std::string>& asked,
                                          const results::MapLayout& layout,
                                          const std::optional<Study>& study) {
  std::vector<std::string> names = chosen_quantities(asked, layout, study);
  const auto add = [&names](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const results::Variable& variable : layout.variables)
    if (is_always_shown(variable.name)) add(variable.name);
  if (!study || !study->sweep() || !study->sweep()->profile) return names;
  for (const std::string& name : profile_quantities(*study, *study->sweep()->profile, layout)) add(name);
  return names;
}

// The names of the parameters along the axes of the map.
std::vector<std::string> axis_parameters(const results::MapLayout& layout,
                                         const std::optional<Study>& study) {
  std::vector<std::string> names;
  if (study) {
    if (!study->map()) return names;
    for (const ParameterAxis& axis : study->map()->axes)
      names.push_back(study->parameters.list[axis.parameter].name);
  } else {
    for (const results::Axis& axis : layout.axes) names.push_back(axis.name);
  }
  return names;
}

std::optional<std::size_t> sample_axis(const std::optional<Study>& study) {
  if (!study || !study->map() || !study->map()->samples) return std::nullopt;
  return study->map()->samples->dimension;
}

}  // namespace

results::PageContent page_content(const results::MapReader& result, const std::filesystem::path& file,
                                  const std::vector<std::string>& quantities, bool all_digits) {
  const std::optional<Study> study = study_of(result, file);
  const std::vector<std::string> shown = shown_quantities(quantities, result.layout(), study);
  check_size(result.layout(), shown.size(), all_digits);
  return {.file = file.filename().string(),
          .parameters = axis_parameters(result.layout(), study),
          .variables = shown,
          .groups = study ? report_facts(*study) : std::vector<results::PageGroup>{},
          .samples = sample_axis(study),
          .all_digits = all_digits};
}

}  // namespace frahm::studies
