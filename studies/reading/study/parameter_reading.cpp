#include "studies/reading/study/parameter_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

std::string where_is(const std::string& name) {
  return fmt::format("parameter \"{}\"", name);
}

Parameter named_parameter(const StudyContext& context, const TomlEntry& entry) {
  const auto fail = [&](Rule rule, std::string_view problem) {
    throw context.source.error_at(rule, entry.position, "[parameters]: \"{}\" {}", entry.key, problem);
  };
  if (!is_identifier(entry.key))
    fail(rules::not_a_name, "is not a name: names are a letter followed by letters, digits and _");
  const auto& reserved = Expression::reserved_names();
  if (std::find(reserved.begin(), reserved.end(), entry.key) != reserved.end()) {
    fail(rules::name_taken, "already has a meaning in expressions; choose another name");
  }
  Parameter parameter;
  parameter.name = entry.key;
  parameter.position = entry.value.position;
  return parameter;
}

// The unit in the header of a column of a table.
std::optional<Unit> unit_of_header(const StudyContext& context, const std::string& file,
                                   const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  if (context.dimensionless) {
    if (*text == "1") return std::nullopt;
    throw StudyError(rules::unit_in_dimensionless,
                     "{}: the unit \"{}\" of its header has no meaning in a dimensionless study", file,
                     *text);
  }
  try {
    return context.units.parse(*text);
  } catch (const UnitError& error) {
    throw StudyError(error.rule(), "{}: its header: {}", file, error.what());
  }
}

void convert(std::vector<double>& values, const Parameter& parameter, const std::optional<Unit>& unit) {
  if (!unit) return;
  const double factor = si_factor(parameter, *unit);
  for (double& value : values) {
    value *= factor;
    if (!std::isfinite(value)) throw UnitError(rules::not_finite, "a value in SI units is out of range");
  }
}

// By the units of its header; without one the numbers are SI.
void convert_table(const StudyContext& context, Parameters& parameters, std::size_t index) {
  Parameter& parameter = parameters.list[index];
  auto& table = std::get<TableOf>(parameter.definition);
  const auto fail = [&](const UnitError& error, const std::string& name) {
    throw context.source.error_at(error.rule(), parameter.position, "{}: {}: its column of \"{}\": {}",
                                  where_is(parameter.name), table.file, name, error.what());
  };
  const Parameter& of = parameters.list[table.of];
  try {
    convert(table.table.x, of, table.of_unit);
  } catch (const UnitError& error) {
    fail(error, of.name);
  }
  try {
    convert(table.table.y, parameter, table.unit);
  } catch (const UnitError& error) {
    fail(error, parameter.name);
  }
}

TableOf read_table(const StudyContext& context, const Parameters& parameters, const std::string& where,
                   const TomlValue& value, const std::filesystem::path& folder) {
  const TomlSection section(context.source, value, where, "{ table, of }");
  TableOf table;
  table.file = section.text("table");
  const std::string of = section.identifier("of");
  const auto index = parameters.find(of);
  if (!index) section.fail(rules::unknown_name, "of", "{}", none_called("parameter", of, parameters.names()));
  table.of = *index;
  try {
    const ReadTable read = read_lookup_table(folder / table.file);
    table.table = read.table;
    table.of_unit = unit_of_header(context, table.file, read.x_unit);
    table.unit = unit_of_header(context, table.file, read.y_unit);
  } catch (const StudyError& error) {
    section.fail(error.rule(), "table", "{}", error.what());
  }
  return table;
}

// For a text such as "3 Hz", which is no expression: how a number with a unit is written.
std::string hint_of_unit(const StudyContext& context, const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (context.dimensionless || error != std::errc{}) return "";
  const std::string_view rest = std::string_view(text).substr(static_cast<std::size_t>(end - text.data()));
  const std::size_t begin = rest.find_first_not_of(" *");
  if (begin == std::string_view::npos) return "";
  const std::string_view unit = rest.substr(begin);
  try {
    context.units.parse(unit);
  } catch (const UnitError&) {
    return "";
  }
  return fmt::format("; a number with a unit is {{ value = {}, unit = \"{}\" }}", number, unit);
}

Expression parsed_expression(const StudyContext& context, const Parameters& parameters,
                             const std::string& where, const TomlValue& value) {
  if (!value.as<std::string>())
    throw context.source.error_at(rules::wrong_type, value.position,
                                  "{}: expected an expression in quotes, found {}", where, described(value));
  const std::string text = read_text(context.source, where, value);
  try {
    return Expression::parse(text, parameters.names());
  } catch (const ExpressionError& error) {
    throw context.source.error_at(error.rule(),
                                  context.source.inside_string(value.position, error.column() - 1),
                                  "{}: {}{}", where, error.what(), hint_of_unit(context, text));
  }
}

void read_definition(const StudyContext& context, const TomlValue& value, const std::filesystem::path& folder,
                     Parameters& parameters, Parameter& parameter) {
  const std::string where = where_is(parameter.name);
  if (value.as<std::string>()) {
    parameter.definition = parsed_expression(context, parameters, where, value);
  } else if (find_entry(value, "table") || find_entry(value, "of")) {
    parameter.definition = read_table(context, parameters, where, value, folder);
  } else {
    const NumberWithUnit number = read_number_with_unit(context, where, value);
    parameter.definition = number.value;
    parameter.unit = number.unit;
    parameter.unit_position = number.unit_position;
  }
}

std::vector<std::size_t> read_by(const Parameter& parameter) {
  if (const auto* expression = std::get_if<Expression>(&parameter.definition)) return expression->reads();
  if (const auto* table = std::get_if<TableOf>(&parameter.definition)) return {table->of};
  return {};
}

// Follows unresolved parameters from one until it is reached again: "a -> b -> a".
std::string circle_through(const Parameters& parameters, const std::vector<bool>& resolved,
                           std::size_t start) {
  std::vector<std::size_t> path;
  for (std::size_t i = start; std::find(path.begin(), path.end(), i) == path.end();) {
    path.push_back(i);
    for (const std::size_t j : read_by(parameters.list[i])) {
      if (!resolved[j]) i = j;
    }
    start = i;
  }
  std::string text;
  for (auto i = std::find(path.begin(), path.end(), start); i != path.end(); ++i) {
    text += parameters.list[*i].name + " -> ";
  }
  return text + parameters.list[start].name;
}

// Puts each derived parameter after everything it reads (Kahn's algorithm); a circle is an error.
void order_derived(const StudyContext& context, Parameters& parameters) {
  const std::size_t count = parameters.list.size();
  std::vector<std::vector<std::size_t>> readers(count);
  std::vector<std::size_t> missing(count), ready;
  for (std::size_t i = 0; i < count; ++i) {
    const auto reads = read_by(parameters.list[i]);
    missing[i] = reads.size();
    for (const std::size_t j : reads) readers[j].push_back(i);
    if (reads.empty()) ready.push_back(i);
  }
  std::vector<bool> resolved(count, false);
  for (std::size_t next = 0; next < ready.size(); ++next) {
    const std::size_t i = ready[next];
    resolved[i] = true;
    if (!parameters.list[i].is_number()) parameters.derived.push_back(i);
    for (const std::size_t reader : readers[i]) {
      if (--missing[reader] == 0) ready.push_back(reader);
    }
  }
  const auto stuck = std::find(resolved.begin(), resolved.end(), false);
  if (stuck == resolved.end()) return;
  const auto i = static_cast<std::size_t>(stuck - resolved.begin());
  throw context.source.error_at(rules::circular_definition, parameters.list[i].position,
                                "{}: its definition is circular: {}", where_is(parameters.list[i].name),
                                circle_through(parameters, resolved, i));
}

}  // namespace

Parameters read_parameters(const StudyContext& context, const TomlValue& root,
                           const std::filesystem::path& folder) {
  Parameters parameters;
  const TomlEntry* section = find_entry(root, "parameters");
  if (!section) return parameters;
  const auto* entries = section->value.as<TomlTable>();
  if (!entries) {
    throw context.source.error_at(rules::wrong_type, section->position,
                                  "[parameters]: expected a table, found {}", described(section->value));
  }
  // Each value is checked at every corner of the grid, with all others: a time in proportion to the square.
  constexpr std::size_t most_parameters = 2000;
  if (entries->size() > most_parameters)
    throw context.source.error_at(rules::too_large, (*entries)[most_parameters].position,
                                  "[parameters]: {} parameters; at most {} are possible", entries->size(),
                                  most_parameters);
  for (const TomlEntry& entry : *entries) parameters.list.push_back(named_parameter(context, entry));
  for (std::size_t i = 0; i < entries->size(); ++i) {
    read_definition(context, (*entries)[i].value, folder, parameters, parameters.list[i]);
  }
  order_derived(context, parameters);
  return parameters;
}

void convert_parameters(const StudyContext& context, Parameters& parameters) {
  for (std::size_t i = 0; i < parameters.list.size(); ++i) {
    Parameter& parameter = parameters.list[i];
    if (std::holds_alternative<TableOf>(parameter.definition)) convert_table(context, parameters, i);
    if (!parameter.unit) continue;
    try {
      auto& value = std::get<double>(parameter.definition);
      value *= si_factor(parameter, *parameter.unit);
      if (!std::isfinite(value)) throw UnitError(rules::not_finite, "the value in SI units is out of range");
    } catch (const UnitError& error) {
      throw context.source.error_at(error.rule(), parameter.unit_position, "{}: {}", where_is(parameter.name),
                                    error.what());
    }
  }
}

NumberWithUnit read_number_with_unit(const StudyContext& context, const std::string& where,
                                     const TomlValue& value) {
  if (is_number(value)) return {read_number(context.source, where, value), std::nullopt, value.position};
  if (!value.as<TomlTable>()) {
    throw context.source.error_at(rules::wrong_type, value.position,
                                  "{}: expected a number, {{ value, unit }} or an expression in quotes, "
                                  "found {}",
                                  where, described(value));
  }
  const TomlSection section(context.source, value, where, "{ value, unit }");
  const double number = section.number("value");
  const TomlValue* unit = section.find("unit");
  if (!unit) return {number, std::nullopt, value.position};
  if (context.dimensionless && unit->as<std::string>()) {
    if (const auto factor = context.units.pure_factor(*unit->as<std::string>()))
      return {number * *factor, std::nullopt, value.position};
  }
  return {number, read_unit(context, where, *unit), unit->position};
}

std::optional<Unit> read_unit(const StudyContext& context, const std::string& where, const TomlValue& value) {
  const std::string text = read_text(context.source, fmt::format("{}: unit", where), value);
  const auto fail = [&](Rule rule, std::string_view message) {
    throw context.source.error_at(rule, value.position, "{}: unit: {}", where, message);
  };
  if (context.dimensionless) {
    if (text != "1")
      fail(
          rules::unit_in_dimensionless,
          fmt::format("\"{}\" has no meaning in a dimensionless study; leave it out or write \"1\" (an angle "
                      "may be {{ value = 90, unit = \"degree\" }}; elsewhere it is in radians)",
                      text));
    return std::nullopt;
  }
  try {
    return context.units.parse(text);
  } catch (const UnitError& error) {
    fail(error.rule(), error.what());
  }
  return std::nullopt;
}

Expression read_expression(const StudyContext& context, const Parameters& parameters,
                           const std::string& where, const TomlValue& value,
                           std::optional<WantedDimension> wanted) {
  const Expression expression = parsed_expression(context, parameters, where, value);
  context.written.push_back({expression, where, value.position, std::move(wanted)});
  return expression;
}

}  // namespace frahm::studies
