#include "studies/map/map_groups.hpp"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "studies/map/known_digits.hpp"
#include "studies/provenance/result_variables.hpp"

namespace frahm::studies {
namespace {

std::string unit_or_one(const std::string& unit) {
  return unit.empty() ? "1" : unit;
}

results::Coordinate coordinate_of(const Study& study, const ParameterAxis& axis) {
  const Parameter& parameter = study.parameters.list[axis.parameter];
  return {.name = parameter.name,
          .unit = unit_or_one(axis.unit),
          .long_name =
              parameter.used_as.empty() ? fmt::format("parameter {}", parameter.name) : parameter.used_as,
          .values = axis.values};
}

results::Coordinate coordinate_of(const RecordAxis& records, const GridDimension& dimension) {
  std::vector<double> numbers(records.names.size());
  std::iota(numbers.begin(), numbers.end(), 0.0);
  return {.name = dimension.name,
          .unit = "1",
          .long_name = Named("record").meaning(),
          .values = std::move(numbers),
          .names = records.names};
}

std::vector<results::Axis> axes_of(const Study& study) {
  std::vector<results::Axis> axes;
  for (const GridDimension& dimension : study.map()->dimensions) {
    results::Axis axis{.name = dimension.name, .size = dimension.size};
    if (dimension.axes.empty()) axis.coordinates.push_back(coordinate_of(*study.map()->records, dimension));
    for (const std::size_t a : dimension.axes)
      axis.coordinates.push_back(coordinate_of(study, study.map()->axes[a]));
    axes.push_back(std::move(axis));
  }
  for (const DerivedCoordinate& derived : study.map()->coordinates) {
    axes[derived.dimension].coordinates.push_back(
        {.name = derived.name,
         .unit = unit_or_one(derived.unit),
         .long_name = derived.long_name.empty() ? derived.name : derived.long_name,
         .values = coordinate_values(study, derived)});
  }
  return axes;
}

}  // namespace

results::Variable parameter_variable(const Study& study, std::size_t parameter, const std::string& unit) {
  const std::string& name = study.parameters.list[parameter].name;
  return variable(Named::by_study(name, "parameter " + name), unit);
}

std::vector<results::Variable> row_variables(const Study& study) {
  std::vector<results::Variable> variables;
  for (const ParameterAxis& axis : study.map()->axes)
    variables.push_back(parameter_variable(study, axis.parameter, axis.unit));
  if (study.map()->records) variables.push_back(variable("record"));
  return variables;
}

std::vector<double> row_values(const Study& study, std::span<const double> parameters, std::size_t record) {
  std::vector<double> row;
  for (const ParameterAxis& axis : study.map()->axes)
    row.push_back(parameters[axis.parameter] / axis.si_factor);
  if (study.map()->records) row.push_back(static_cast<double>(record));
  return row;
}

results::Variable variable_of(const Study& study, const periodic::QuantityDescription& description) {
  results::Variable variable{
      .name = description.name, .unit = description.unit, .long_name = description.long_name};
  variable.significant_bits = bits_of(study, description);
  if (description.kind == periodic::QuantityKind::count) variable.type = results::Type::int32;
  if (description.kind == periodic::QuantityKind::real &&
      study.map()->output.precision == Precision::single) {
    variable.type = results::Type::float32;
    if (variable.significant_bits > diagnostic_bits) variable.significant_bits = 0;  // more than it holds
  }
  if (description.kind == periodic::QuantityKind::flag) {
    variable.type = results::Type::flag;
    variable.unit.clear();
    for (const auto& [meaning, value] : description.flags) variable.flags.push_back({meaning, value});
  }
  return variable;
}

results::MapLayout map_layout(const MapPlan& plan, const RunFacts& run) {
  results::MapLayout layout = file_layout(plan, run);
  layout.axes = axes_of(plan.study);
  layout.chunk = plan.grid.chunk;
  for (const auto& variable : plan.variables) layout.variables.push_back(variable_of(plan.study, variable));
  return layout;
}

}  // namespace frahm::studies
