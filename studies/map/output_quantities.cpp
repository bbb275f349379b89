#include "studies/map/output_quantities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "solvers/mechanics/coordinates.hpp"
#include "studies/map/comparison.hpp"
#include "studies/reading/text/name_pattern.hpp"

namespace frahm::studies {
namespace {

std::string name_of(const Study& study, const periodic::Quantity& quantity) {
  return periodic::describe(quantity, study.network, study.dimensionless).name;
}

[[noreturn]] void refuse_unknown(const Study& study, const OutputChoice::Name& name) {
  std::vector<std::string> known;
  for (const auto& each : periodic::all_quantities(study.network)) known.push_back(name_of(study, each));
  throw study.source.error_at(rules::unknown_name, name.position,
                              "[output]: quantities: there is no \"{}\"{}", name.text,
                              hint_of_unmatched(name.text, known));
}

// The quantities of a name, or of a pattern of names.
std::vector<periodic::Quantity> quantities_called(const Study& study, const OutputChoice::Name& name) {
  std::vector<periodic::Quantity> found;
  if (is_pattern(name.text)) {
    for (const periodic::Quantity& each : periodic::all_quantities(study.network))
      if (matches(name.text, name_of(study, each))) found.push_back(each);
  } else if (const auto quantity = periodic::find_quantity(name.text, study.network)) {
    found.push_back(*quantity);
  }
  if (found.empty()) refuse_unknown(study, name);
  return found;
}

std::vector<periodic::Quantity> listed_quantities(const Study& study) {
  std::vector<periodic::Quantity> result;
  for (const OutputChoice::Name& name : study.map()->output.names) {
    for (const periodic::Quantity& quantity : quantities_called(study, name))
      if (std::find(result.begin(), result.end(), quantity) == result.end()) result.push_back(quantity);
  }
  return periodic::with_always_stored(std::move(result), study.network);
}

// A name in the record chosen by the study, and its position.
struct Taken {
  std::string what;
  Position position;
};

std::map<std::string, Taken> names_of_coordinates(const Study& study) {
  std::map<std::string, Taken> taken;
  for (const GridDimension& dimension : study.map()->dimensions) {
    const Position position = dimension.axes.empty() ? study.map()->records->position
                                                     : study.map()->axes[dimension.axes.front()].position;
    taken.emplace(dimension.name, Taken{"the dimension of an axis", position});
  }
  for (const ParameterAxis& axis : study.map()->axes) {
    taken.emplace(study.parameters.list[axis.parameter].name,
                  Taken{"the parameter of an axis", axis.position});
  }
  for (const DerivedCoordinate& coordinate : study.map()->coordinates) {
    taken.emplace(coordinate.name, Taken{"a coordinate", coordinate.value.position});
  }
  return taken;
}

// Groups of the file and their contents next to the axes' own parameters.
std::vector<std::pair<std::string, std::string>> names_of_groups(const Study& study) {
  std::vector<std::pair<std::string, std::string>> names{{"provenance", "a group of the file"},
                                                         {"page", "a group of the file"},
                                                         {"modes", "a group of the file"}};
  for (const char* name : {"mode", "mode_mass", "mode_frequency", "mode_damping"})
    names.emplace_back(name, "a variable of the modes");
  const auto add = [&](const std::string& name, const char* what) { names.emplace_back(name, what); };
  if (!study.map()->output.histories.empty()) {
    const bool of_motions = study.transient() != nullptr;
    add(of_motions ? "histories" : "orbits", "a group of the file");
    for (const char* name : {of_motions ? "history" : "orbit", "sample", "row_start", "time"})
      add(name, of_motions ? "a variable of the kept histories" : "a variable of the kept orbits");
  }
  if (study.transient()) return names;
  if (study.sweep()->borders) {
    add("borders", "a group of the file");
    for (const char* name : {"border", "element", "axis", "regime_below", "regime_above"})
      add(name, "a variable of the borders");
  }
  if (study.sweep()->branches) {
    add("branches", "a group of the file");
    for (const char* name : {"branch", "place", "row_start", "period_multiple", "first_end", "last_end",
                             "arclength", "stability", "special", "special_residual", "special_element"})
      add(name, "a variable of the branches");
  }
  if (study.sweep()->resonances.empty()) return names;
  add("resonance", "a group of the file");
  add("curve", "the index of the resonances");
  for (const std::size_t mass : study.sweep()->resonances) {
    for (const char* suffix : {"_resonance_frequency", "_resonance_amplitude", "_half_power_low",
                               "_half_power_high", "_half_power_damping"})
      add(mechanics::coordinate_name(study.network, mass) + suffix, "a variable of the resonances");
  }
  return names;
}

// A page and a summary can only show recorded quantities.
void check_report(const Study& study, const std::vector<periodic::QuantityDescription>& recorded) {
  std::vector<std::string> names;
  for (const periodic::QuantityDescription& quantity : recorded) names.push_back(quantity.name);
  const auto check = [&](const char* key, const OutputChoice::Name& name) {
    if (std::ranges::any_of(names, [&](const std::string& each) { return matches(name.text, each); })) return;
    throw study.source.error_at(
        rules::unknown_name, name.position,
        "[report]: {}: this study does not record \"{}\"{}; choose it in [output] quantities", key, name.text,
        hint_of_unmatched(name.text, names));
  };
  for (const OutputChoice::Name& name : study.map()->report_quantities) check("quantities", name);
  if (study.map()->headline) check("headline", *study.map()->headline);
  if (!study.sweep()) return;
  const auto& profile = study.sweep()->profile;
  if (!profile || !profile->position) return;
  for (const std::size_t mass : profile->masses) {
    const std::string peak = name_of(study, {periodic::Measure::peak, mass});
    if (std::find(names.begin(), names.end(), peak) != names.end()) continue;
    throw study.source.error_at(rules::unknown_name, *profile->position,
                                "[report]: profile: it shows \"{}\", which this study does not record; "
                                "choose it in [output] quantities",
                                peak);
  }
}

}  // namespace

std::vector<periodic::Quantity> output_quantities(const Study& study) {
  switch (study.map()->output.quantities) {
    case OutputChoice::Quantities::all:
      return periodic::all_quantities(study.network);
    case OutputChoice::Quantities::listed:
      return listed_quantities(study);
    case OutputChoice::Quantities::standard:
      break;
  }
  return periodic::standard_quantities(study.network);
}

std::string headline_of(const Study& study) {
  const auto& headline = study.map()->headline;
  return headline ? headline->text : study.network.masses.front() + "_peak";
}

std::vector<periodic::QuantityDescription> output_variables(
    const Study& study, const std::vector<periodic::Quantity>& quantities) {
  std::vector<periodic::QuantityDescription> result;
  for (const periodic::Quantity& quantity : quantities)
    result.push_back(periodic::describe(quantity, study.network, study.dimensionless));
  if (study.sweep()->comparison) {
    const auto compared = compared_variables(study);
    result.insert(result.end(), compared.begin(), compared.end());
  }
  check_names_in_file(study, result);
  return result;
}

void check_names_in_file(const Study& study, const std::vector<periodic::QuantityDescription>& variables) {
  std::map<std::string, Taken> taken = names_of_coordinates(study);
  for (const auto& [name, what] : names_of_groups(study)) {
    const auto other = taken.find(name);
    if (other == taken.end()) continue;
    throw study.source.error_at(rules::name_taken, other->second.position,
                                "\"{}\" is the name of {} and of {}, which are in the same file; rename it",
                                name, other->second.what, what);
  }
  for (const auto& variable : variables) {
    const auto [other, is_free] = taken.try_emplace(variable.name, Taken{variable.long_name, {}});
    if (is_free) continue;
    throw study.source.error_at(
        rules::name_taken, other->second.position,
        "\"{}\" is the name of {} and of a result ({}), which are in the same file; rename it", variable.name,
        other->second.what, variable.long_name);
  }
  check_report(study, variables);
}

}  // namespace frahm::studies
