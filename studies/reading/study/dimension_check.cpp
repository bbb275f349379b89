#include "studies/reading/study/dimension_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/reading/quantities/expression_dimension.hpp"

namespace frahm::studies {
namespace {

// A parameter has the dimension of its unit, a table's that of its header. Plain numbers, tables without one
// and quantities beyond mechanics may have any.
ExpressionDimension dimension_of_number(const Parameter& parameter) {
  const auto* table = std::get_if<TableOf>(&parameter.definition);
  const std::optional<Unit>& unit = table            ? table->unit
                                    : parameter.unit ? parameter.unit
                                                     : parameter.unit_of_range;
  if (!unit || unit->foreign) return {};
  return exponents_of(*unit);
}

ExpressionDimension checked_dimension(const StudyContext& context, const Expression& expression,
                                      std::span<const ExpressionDimension> of_parameters,
                                      const std::string& where, Position position,
                                      PlainFactor plain = PlainFactor::any_dimension) {
  try {
    return dimension_of(expression, of_parameters, plain);
  } catch (const ExpressionError& error) {
    throw context.source.error_at(error.rule(), context.source.inside_string(position, error.column() - 1),
                                  "{}: {}", where, error.what());
  }
}

// is_asked: of which parameters, and all that they read; other expressions are not reported.
std::vector<ExpressionDimension> dimensions_of(const StudyContext& context, const Parameters& parameters,
                                               const std::vector<bool>& is_asked,
                                               PlainFactor plain = PlainFactor::any_dimension) {
  std::vector<ExpressionDimension> dimensions;
  for (const Parameter& parameter : parameters.list) dimensions.push_back(dimension_of_number(parameter));
  for (const std::size_t i : parameters.derived) {
    const Parameter& parameter = parameters.list[i];
    const auto* expression = std::get_if<Expression>(&parameter.definition);
    if (expression && is_asked[i])
      dimensions[i] =
          checked_dimension(context, *expression, dimensions, fmt::format("parameter \"{}\"", parameter.name),
                            parameter.position, plain);
  }
  return dimensions;
}

// The parameters that an expression reads, by itself or by way of others.
std::vector<bool> read_by(const Expression& expression, const Parameters& parameters) {
  std::vector<bool> is_read(parameters.list.size(), false);
  const auto note = [&](const Expression& reader) {
    for (const std::size_t i : reader.reads()) is_read[i] = true;
  };
  note(expression);
  for (auto i = parameters.derived.rbegin(); i != parameters.derived.rend(); ++i) {
    const auto* inner = std::get_if<Expression>(&parameters.list[*i].definition);
    if (inner && is_read[*i]) note(*inner);
  }
  return is_read;
}

// A law of the frequency alone, such as amplitude = "omega^2" of an unbalance of 1 kg m, may leave its factor
// out.
bool lacks_only_a_factor(const Exponents& found, const Exponents& wanted) {
  const auto is_of_time = [](const Exponents& of) { return of[0] == 0.0 && of[1] == 0.0; };
  return is_of_time(found) && found[2] != 0.0 && !is_of_time(wanted);
}

// g is the gram in UDUNITS, and often written for the acceleration.
std::string hint_at_gram(const Parameters& parameters, const Expression& expression) {
  for (const std::size_t i : parameters.inputs_of(expression.reads())) {
    const Parameter& parameter = parameters.list[i];
    if (parameter.unit && parameter.unit->text == "g")
      return fmt::format("; the unit \"g\" of \"{}\" is the gram, the standard acceleration is \"gravity\"",
                         parameter.name);
  }
  return "";
}

}  // namespace

WantedDimension wanted_by_key(Quantity quantity) {
  const Unit unit = coherent_unit_of(quantity);
  const bool has_unit = unit.text != si_unit(Quantity::number);
  return {unit, fmt::format("{}{} is expected", quantity_name(quantity),
                            has_unit ? fmt::format(" ({})", written_si_unit(quantity)) : "")};
}

WantedDimension wanted_by_label(const Unit& unit) {
  return {unit, fmt::format("its unit \"{}\" is that of {}", unit.text, dimension_name(unit))};
}

ExpressionDimension dimension_of_geometry(const StudyContext& context, const Parameters& parameters,
                                          const Expression& expression, const std::string& where,
                                          Position position) {
  const std::vector<ExpressionDimension> dimensions =
      dimensions_of(context, parameters, read_by(expression, parameters), PlainFactor::pure_number);
  const ExpressionDimension found =
      checked_dimension(context, expression, dimensions, where, position, PlainFactor::pure_number);
  const std::vector<std::size_t> inputs = parameters.inputs_of(expression.reads());
  const bool all_known = !inputs.empty() && std::ranges::all_of(inputs, [&](std::size_t i) {
    return dimensions[i].has_value();
  });
  const bool is_length = found && same(*found, {1.0, 0.0, 0.0});
  return all_known || is_length ? found : ExpressionDimension{};
}

void check_dimensions(const StudyContext& context, const Parameters& parameters) {
  if (context.dimensionless) return;
  const std::vector<ExpressionDimension> dimensions =
      dimensions_of(context, parameters, std::vector<bool>(parameters.list.size(), true));
  for (const WrittenExpression& written : context.written) {
    const auto& [expression, where, position, wanted] = written;
    const ExpressionDimension found = checked_dimension(context, expression, dimensions, where, position);
    if (!found || !wanted || wanted->unit.foreign) continue;
    const Exponents expected = exponents_of(wanted->unit);
    if (same(*found, expected) || lacks_only_a_factor(*found, expected)) continue;
    throw context.source.error_at(rules::wrong_dimension, position, "{}: the expression is {}, but {}{}",
                                  where, described(*found), wanted->sentence,
                                  hint_at_gram(parameters, expression));
  }
}

}  // namespace frahm::studies
