#include "studies/record/study_changes.hpp"

#include <fmt/format.h>

#include <map>

#include "results/map_reader.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "studies/reading/settings.hpp"
#include "studies/record/stored_study.hpp"

namespace frahm::studies {
namespace {

// What of a study is called what, by name, in the words of its author.
using Facts = std::map<std::string, std::string>;

std::string with_unit(double value, const std::string& unit) {
  return unit.empty() ? fmt::format("{}", value) : fmt::format("{} {}", value, unit);
}

void add_parameters_of(const Study& study, Facts& facts) {
  const auto names = study.parameters.names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& definition = study.parameters.list[i].definition;
    std::string& fact = facts["parameter " + names[i]];
    if (const auto* number = std::get_if<double>(&definition)) {
      const SpokenValue spoken = spoken_value(study, i, *number);
      fact = with_unit(spoken.value, spoken.unit);
    } else if (const auto* expression = std::get_if<Expression>(&definition)) {
      fact = expression->canonical_text(names);
    } else {
      fact = "the table " + std::get<TableOf>(definition).file;
    }
  }
}

void add_values_of(const Study& study, Facts& facts) {
  const auto names = study.parameters.names();
  const auto add = [&](const StudyValue& value) {
    if (!value.where.empty()) facts[value.where] = value.expression.canonical_text(names);
  };
  add(study.values.omega);
  for (const auto* list : study.values.lists()) {
    for (const StudyValue& value : *list) add(value);
  }
  for (const mechanics::Element& element : study.network.elements) {
    std::string& fact = facts[fmt::format("element \"{}\"", element.name)];
    fact = fmt::format("{}, along", mechanics::kind_of(element.type).name);
    for (const mechanics::Share& share : element.along) {
      const auto& [node, factor] = share;
      const std::string name = node.kind == mechanics::NodeKind::ground ? "ground"
                               : node.kind == mechanics::NodeKind::mass
                                   ? study.network.masses[node.index]
                                   : study.network.prescribed[node.index];
      fact += fmt::format(" {} {}", factor, name);
    }
  }
}

void add_axes_of(const Study& study, Facts& facts) {
  if (!study.map()) return;
  for (const ParameterAxis& axis : study.map()->axes) {
    const std::string& name = study.parameters.list[axis.parameter].name;
    facts["axis " + name] =
        fmt::format("{} points from {} to {}", axis.values.size(), with_unit(axis.values.front(), axis.unit),
                    with_unit(axis.values.back(), axis.unit));
    facts.erase("parameter " + name);  // its value is that of the axis
  }
}

Facts facts_of(const Study& study) {
  Facts facts;
  add_parameters_of(study, facts);
  add_values_of(study, facts);
  add_axes_of(study, facts);
  return facts;
}

}  // namespace

std::vector<std::string> study_changes(const Study& kept, const Study& now) {
  if (kept.kind() != now.kind())
    return {fmt::format("kind: \"{}\", now \"{}\"", kind_name(kept.kind()), kind_name(now.kind()))};
  const Facts before = facts_of(kept), after = facts_of(now);
  std::vector<std::string> changes;
  for (const auto& [name, fact] : before) {
    const auto found = after.find(name);
    if (found == after.end())
      changes.push_back(fmt::format("{}: {}, now gone", name, fact));
    else if (found->second != fact)
      changes.push_back(fmt::format("{}: {}, now {}", name, fact, found->second));
  }
  for (const auto& [name, fact] : after) {
    if (!before.contains(name)) changes.push_back(fmt::format("{}: new, {}", name, fact));
  }
  return changes;
}

std::vector<std::string> changes_since(const std::filesystem::path& result, const Study& now) {
  try {
    return study_changes(read_stored_study(results::MapReader(result), result).study, now);
  } catch (const StudyError&) {  // its tables may be gone, or it was written by another version
    return {};
  }
}

}  // namespace frahm::studies
