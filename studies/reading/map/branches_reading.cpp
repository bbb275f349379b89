#include "studies/reading/map/branches_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "studies/reading/study/assignment_reading.hpp"
#include "studies/reading/system/unfit_elements.hpp"
#include "studies/reading/text/toml_reading.hpp"

// `branches` of [output].
namespace frahm::studies {
namespace {

constexpr std::size_t most_elements = 125;  // values of a flag, next to "not_computed" and "none"

const std::string& name_of(const Study& study, const ParameterAxis& axis) {
  return study.parameters.list[axis.parameter].name;
}

// Refuses an axis along which nothing can be followed. where: of `along`, or of `branches`.
void check_axis(const TomlSection& section, const char* key, const Study& study, const ParameterAxis& axis) {
  const auto& samples = study.map()->samples;
  if (samples && axis.zip == study.map()->dimensions[samples->dimension].name)
    section.fail(rules::unfit_axis, key, "a branch follows a range, but \"{}\" has samples in no order",
                 name_of(study, axis));
  if (!axis.zip.empty())
    section.fail(rules::unfit_axis, key,
                 "a branch follows one parameter, but \"{}\" advances with the others of \"{}\"",
                 name_of(study, axis), axis.zip);
  if (axis.values.size() < 2)
    section.fail(rules::unfit_axis, key, "a branch follows a range, but \"{}\" has one value",
                 name_of(study, axis));
}

// The axis that runs innermost.
std::size_t innermost_axis(const SweepChoice& sweep) {
  const std::size_t dimension = sweep.frequency_dimension.value_or(sweep.dimensions.size() - 1);
  return sweep.dimensions[dimension].axes.front();
}

std::size_t axis_called(const TomlSection& section, const Study& study, const std::string& name) {
  const auto& axes = study.map()->axes;
  const auto found =
      std::ranges::find_if(axes, [&](const ParameterAxis& axis) { return name_of(study, axis) == name; });
  if (found != axes.end()) return static_cast<std::size_t>(found - axes.begin());
  std::string names;
  for (const ParameterAxis& axis : axes) names += (names.empty() ? "" : ", ") + name_of(study, axis);
  section.fail(rules::unknown_name, "along", "no axis is called \"{}\"; there are {}", name, names);
}

// One table of `at`.
std::vector<Assignment> read_row(const StudyContext& context, const Study& study, const TomlValue& value,
                                 std::size_t along) {
  const std::string where = "[output]: branches: at";
  const auto* entries = value.as<TomlTable>();
  if (!entries || entries->empty())
    throw context.source.error_at(rules::wrong_type, value.position,
                                  "{}: a row is a table such as {{ f = 0.1 }}, found {}", where,
                                  entries ? "an empty table" : described(value));
  const auto& axes = study.map()->axes;
  const WhyNot why_not = [&](std::size_t parameter) {
    const ParameterAxis* axis = of_parameter(axes, parameter);
    return !axis ? "it is not an axis of the map" : axis == &axes[along] ? "the branches follow it" : "";
  };
  std::vector<Assignment> row;
  for (const TomlEntry& entry : *entries) {
    row.push_back(read_assignment(context, study, where, entry, why_not));
    const ParameterAxis* axis = of_parameter(axes, row.back().parameter);
    const auto is_value = [&](double each) { return is_on_axis(row.back().value, each); };
    if (std::ranges::any_of(axis->si_values, is_value)) continue;
    const double wanted = row.back().value / axis->si_factor;
    const double nearest = *std::ranges::min_element(
        axis->values, {}, [wanted](double each) { return std::abs(each - wanted); });
    throw context.source.error_at(rules::beyond_schema(rules::out_of_range), entry.value.position,
                                  "{}: {}: {} is not a value of this axis; the nearest is {}", where,
                                  entry.key, wanted, nearest);
  }
  return row;
}

void read_rows(const StudyContext& context, const TomlSection& section, const Study& study,
               BranchChoice& choice) {
  const TomlValue* value = section.find("at");
  if (!value) return;
  const auto* rows = value->as<TomlArray>();
  if (!rows || rows->empty())
    section.fail(rules::wrong_type, "at", "expected an array of rows such as [{{ f = 0.1 }}], found {}",
                 rows ? "an empty array" : described(*value));
  for (const TomlValue& row : *rows) choice.at.push_back(read_row(context, study, row, choice.axis));
}

void check_elements(const TomlSection& section, const Study& study) {
  const auto& elements = study.network.elements;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const mechanics::Element& element = elements[e];
    if (mechanics::has_smooth_law(element))
      section.fail(rules::wrong_law, "branches",
                   "element \"{}\" follows the law \"{}\", which is integrated, but branches need exact laws",
                   element.name, smooth_key(study, e).law);
    if (element.name == "none" || element.name == "not_computed")
      section.fail(rules::name_taken, "branches",
                   "\"{}\" means no element in the record of branches; rename this element", element.name);
  }
  const std::size_t with_events = elements_with_events(study.network).size();
  if (with_events > most_elements)
    section.fail(rules::too_large, "branches",
                 "{} elements may begin to stop or to touch; at most {} can be distinguished", with_events,
                 most_elements);
}

}  // namespace

void read_branches(const StudyContext& context, const TomlSection& output, Study& study) {
  const TomlValue* value = output.find("branches");
  if (!value) return;
  BranchChoice choice;
  if (value->as<TomlTable>()) {
    const TomlSection section(context.source, *value, "[output]: branches", "output.branches");
    choice.axis = section.find("along") ? axis_called(section, study, section.text("along"))
                                        : innermost_axis(*study.sweep());
    if (section.find("along"))
      check_axis(section, "along", study, study.map()->axes[choice.axis]);
    else
      check_axis(output, "branches", study, study.map()->axes[choice.axis]);
    read_rows(context, section, study, choice);
  } else {
    if (!value->as<bool>())
      output.fail(rules::wrong_type, "branches",
                  "expected true, or a table such as {{ along = \"r\", at = [{{ f = 0.1 }}] }}, found {}",
                  described(*value));
    if (!*value->as<bool>()) return;
    choice.axis = innermost_axis(*study.sweep());
    check_axis(output, "branches", study, study.map()->axes[choice.axis]);
  }
  check_elements(output, study);
  study.sweep()->branches = std::move(choice);
}

}  // namespace frahm::studies
