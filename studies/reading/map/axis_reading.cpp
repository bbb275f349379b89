#include "studies/reading/map/axis_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/reading/map/record_axis.hpp"
#include "studies/reading/map/sample_axis_reading.hpp"
#include "studies/reading/study/dimension_check.hpp"
#include "studies/reading/study/parameter_reading.hpp"

namespace frahm::studies {
std::optional<Refusal> why_no_axis(const Study& study, const std::string& name) {
  if (auto refusal = why_not_a_number(study.parameters, name, "an axis needs one that is a number"))
    return refusal;
  if (const auto* other = of_parameter(study.map()->axes, *study.parameters.find(name)))
    return Refusal{rules::given_twice,
                   fmt::format("\"{}\" already has an axis (line {})", name, other->position.line)};
  return std::nullopt;
}

std::size_t read_axis_parameter(const TomlSection& section, const Study& study) {
  const std::string name = section.text("parameter");
  if (const auto refusal = why_no_axis(study, name))
    section.fail(refusal->rule, "parameter", "{}", refusal->text);
  return *study.parameters.find(name);
}

void set_axis_unit(const std::optional<Unit>& unit, Parameter& parameter, ParameterAxis& axis) {
  if (unit) {
    axis.si_factor = si_factor(parameter, *unit);
    axis.unit = unit->text;
    parameter.unit_of_range = unit;
  } else if (parameter.unit) {
    if (si_factor(parameter, *parameter.unit) != 1.0) {
      throw UnitError(
          rules::missing_unit,
          fmt::format(
              "the parameter is given in \"{0}\", but its axis has no unit; add unit = \"{0}\" or another",
              parameter.unit->text));
    }
    axis.unit = parameter.unit->text;
  } else if (parameter.quantity) {
    axis.unit = si_unit(*parameter.quantity);
  }
}

void read_axis_unit(const StudyContext& context, const TomlSection& section, Parameter& parameter,
                    ParameterAxis& axis) {
  const TomlValue* value = section.find("unit");
  std::optional<Unit> unit;
  if (value) unit = read_unit(context, section.where(), *value);
  if (context.dimensionless) {
    axis.unit = si_unit(Quantity::number);
    return;
  }
  try {
    set_axis_unit(unit, parameter, axis);
  } catch (const UnitError& error) {
    if (!value) section.fail_here(error.rule(), "{}", error.what());
    section.fail(error.rule(), "unit", "{}", error.what());
  }
}

void convert_axis(const TomlSection& section, ParameterAxis& axis) {
  for (const double value : axis.values) {
    axis.si_values.push_back(value * axis.si_factor);
    if (!std::isfinite(axis.si_values.back()))
      section.fail_here(rules::not_finite, "{} is out of range in SI units", value);
  }
}

constexpr std::size_t most_dimensions = 32;  // of an array in HDF5

void add_to_grid(const TomlSection& section, std::size_t index, Study& study) {
  const ParameterAxis& axis = study.map()->axes[index];
  for (GridDimension& dimension : study.map()->dimensions) {
    if (dimension.axes.empty()) continue;  // of records
    const ParameterAxis& other = study.map()->axes[dimension.axes.front()];
    if (axis.zip.empty() || other.zip != axis.zip) continue;
    if (axis.values.size() != dimension.size) {
      section.fail(rules::beyond_schema(rules::wrong_length), "zip",
                   "{} values cannot advance together with the {} of axis \"{}\" (line {})",
                   axis.values.size(), dimension.size, study.parameters.list[other.parameter].name,
                   other.position.line);
    }
    dimension.axes.push_back(index);
    return;
  }
  const std::string& name = axis.zip.empty() ? study.parameters.list[axis.parameter].name : axis.zip;
  if (study.map()->dimensions.size() == most_dimensions)
    section.fail_here(rules::too_large, "a map has at most {} dimensions; zip axes that advance together",
                      most_dimensions);
  study.map()->dimensions.push_back({name, {index}, axis.values.size()});
}

namespace {

constexpr double most_grid_points = 1e12;  // ages of computing, and far from overflow

// n values from a to b, both exactly; equal steps or equal ratios.
std::vector<double> spaced(double from, double to, std::size_t points, bool logarithmic) {
  std::vector<double> values(points);
  for (std::size_t i = 0; i < points; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(points - 1);
    values[i] = logarithmic ? from * std::pow(to / from, part) : std::lerp(from, to, part);
  }
  values.back() = to;
  return values;
}

std::vector<double> read_range(const TomlSection& section) {
  const double from = section.number("from");
  const double to = section.number("to");
  const std::int64_t points = section.integer("points");
  if (from == to)
    section.fail(rules::wrong_order, "to", "\"from\" and \"to\" are the same, {}; write values = [...]", to);
  const bool logarithmic = section.choice("spacing") == "log";
  for (const char* end : {"from", "to"}) {
    if (logarithmic && !(section.number(end) > 0.0)) {
      section.fail(rules::beyond_schema(rules::out_of_range), end,
                   "{} is not possible with spacing = \"log\": both ends must be > 0", section.number(end));
    }
  }
  return spaced(from, to, static_cast<std::size_t>(points), logarithmic);
}

std::vector<double> read_listed(const TomlSection& section) {
  const TomlValue& list = section.require("values");
  const auto* items = list.as<TomlArray>();
  if (!items)
    section.fail(rules::wrong_type, "values", "expected an array of numbers, found {}", described(list));
  if (items->empty())
    section.fail(rules::empty, "values", "the array is empty; an axis needs at least one value");
  std::vector<double> values;
  for (const TomlValue& item : *items) {
    values.push_back(read_number(section.source(), fmt::format("{}: values", section.where()), item));
  }
  return values;
}

// A repeated value is a mistake, except in a zip, where the other axes distinguish the points.
void check_values_differ(const TomlSection& section, const ParameterAxis& axis) {
  std::vector<double> sorted = axis.values;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end() && axis.zip.empty()) {
    section.fail(rules::given_twice, section.find("values") ? "values" : "points", "{} appears twice",
                 *twice);
  }
}

void read_axis(const StudyContext& context, const TomlValue& table, std::size_t number, Study& study) {
  const TomlSection section(context.source, table, label(table, "axis", "parameter", "axis", number), "axis",
                            "numbers");
  ParameterAxis axis;
  axis.position = section.position();
  axis.parameter = read_axis_parameter(section, study);
  read_axis_unit(context, section, study.parameters.list[axis.parameter], axis);
  axis.values = section.find("values") ? read_listed(section) : read_range(section);
  if (section.find("zip")) {
    axis.zip = section.identifier("zip");
    axis.zip_position = section.require("zip").position;
  }
  convert_axis(section, axis);
  check_values_differ(section, axis);
  study.map()->axes.push_back(std::move(axis));
  add_to_grid(section, study.map()->axes.size() - 1, study);
}

// Dimensions, axes and coordinates share the names of the record.
void check_zip_names(const StudyContext& context, const Study& study) {
  for (const ParameterAxis& zipped : study.map()->axes) {
    for (const ParameterAxis& axis : study.map()->axes) {
      if (zipped.zip != study.parameters.list[axis.parameter].name) continue;
      throw context.source.error_at(rules::name_taken, zipped.zip_position,
                                    "axis \"{}\": zip: \"{}\" is the name of a parameter "
                                    "on an axis; give the zip a name of its own",
                                    study.parameters.list[zipped.parameter].name, zipped.zip);
    }
  }
}

}  // namespace

void read_axes(const StudyContext& context, const TomlValue& root, const std::filesystem::path& folder,
               DataFiles data, Study& study) {
  const auto tables = read_tables(context.source, root, "axis");
  if (tables.empty())
    throw context.source.error_at(rules::missing_section, root.position,
                                  "the study has no [[axis]]: a sweep needs one");
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (is_record_axis(*tables[i]))
      add_record_axis(context, root, *tables[i], study);
    else if (is_axis_of_samples(*tables[i]))
      read_axis_of_samples(context, *tables[i], i + 1, folder, data, study);
    else
      read_axis(context, *tables[i], i + 1, study);
  }
  check_zip_names(context, study);
  double points = 1.0;
  for (const GridDimension& dimension : study.map()->dimensions)
    points *= static_cast<double>(dimension.size);
  if (points > most_grid_points) {
    throw context.source.error_at(rules::too_large, tables.back()->position,
                                  "the grid has {:.3g} points, but at most {:.0e} are allowed", points,
                                  most_grid_points);
  }
}

void read_coordinates(const StudyContext& context, const TomlValue& root, Study& study) {
  std::size_t number = 0;
  for (const TomlValue* table : read_tables(context.source, root, "coordinate")) {
    const TomlSection section(context.source, *table,
                              label(*table, "coordinate", "name", "coordinate", ++number), "coordinate");
    DerivedCoordinate coordinate;
    coordinate.name = section.identifier("name");
    std::vector<std::string> taken = study.parameters.names();
    for (const GridDimension& dimension : study.map()->dimensions) taken.push_back(dimension.name);
    for (const DerivedCoordinate& other : study.map()->coordinates) taken.push_back(other.name);
    if (std::find(taken.begin(), taken.end(), coordinate.name) != taken.end()) {
      section.fail(rules::name_taken, "name",
                   "the name is taken by a parameter, a zip or another coordinate");
    }
    const TomlValue& value = section.require("value");
    coordinate.value.where = fmt::format("{}: value", section.where());
    coordinate.value.position = value.position;
    std::optional<WantedDimension> wanted;
    if (const TomlValue* unit = section.find("unit")) {
      if (const auto read = read_unit(context, section.where(), *unit)) {
        coordinate.unit = read->text;
        coordinate.si_factor = factor_of_label(study.parameters, section.text("value"), *read);
        wanted = wanted_by_label(*read);
      }
    }
    coordinate.value.expression =
        read_expression(context, study.parameters, coordinate.value.where, value, wanted);
    coordinate.long_name = section.text_or("long_name", "");
    const auto moving = dimensions_moving(study, coordinate.value.expression.reads());
    if (moving.size() != 1) {
      section.fail(
          rules::wrong_dependence, "value",
          "depends on {}; a coordinate may depend only on the parameters of one axis (or of one zip)",
          moving.empty() ? "no axis" : "several axes");
    }
    coordinate.dimension = moving.front();
    study.map()->coordinates.push_back(std::move(coordinate));
  }
}

}  // namespace frahm::studies
