#include "studies/reading/factor_dimension.hpp"

#include <algorithm>
#include <cmath>

namespace frahm::studies {
namespace {

constexpr std::size_t metre = 0;  // in Unit::exponents

// The power of a base unit in an expression's unit, by Euler's theorem on homogeneous functions: with
// parameters p_i of powers n_i, sum_i n_i p_i df/dp_i = n f. In whatever units the parameters are given.
double power_of(std::size_t base, const Expression& expression, const Parameters& parameters) {
  std::vector<Dual> values;
  for (const double value : parameters.nominal()) values.push_back({value, 0.0});
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& unit = parameters.list[i].unit;
    if (unit) values[i].derivative = unit->exponents[base] * values[i].value;
  }
  for (const std::size_t i : parameters.derived) {
    if (const auto* inner = std::get_if<Expression>(&parameters.list[i].definition))
      values[i] = inner->evaluate(std::span<const Dual>(values));
  }
  const Dual result = expression.evaluate(std::span<const Dual>(values));
  return result.derivative / result.value;
}

std::optional<FactorDimension> dimension_of_power(double power) {
  constexpr double rounding = 1e-9;
  const auto is = [&](double whole) { return std::abs(power - whole) < rounding; };
  if (is(0.0)) return FactorDimension::number;
  if (is(1.0)) return FactorDimension::length;
  if (is(-1.0)) return FactorDimension::per_length;
  return std::nullopt;
}

}  // namespace

std::optional<FactorDimension> dimension_of(const Unit& unit) {
  if (unit.foreign || unit.exponents[1] != 0 || unit.exponents[2] != 0 || std::abs(unit.radians) > 1)
    return std::nullopt;
  return dimension_of_power(unit.exponents[metre]);
}

std::optional<FactorDimension> dimension_of(const Expression& factor, const Parameters& parameters) {
  const std::vector<std::size_t> inputs = parameters.inputs_of(factor.reads());
  const bool all_known = !inputs.empty() && std::ranges::all_of(inputs, [&](std::size_t i) {
    return parameters.list[i].unit.has_value();
  });
  const double length = power_of(metre, factor, parameters);
  if (!std::isfinite(length)) return FactorDimension::unknown;  // 0, or no value: refused as such
  const auto known = dimension_of_power(length);
  if (!all_known) return known == FactorDimension::length ? known : FactorDimension::unknown;
  for (const std::size_t other : {1, 2}) {
    if (dimension_of_power(power_of(other, factor, parameters)) != FactorDimension::number)
      return std::nullopt;
  }
  return known;
}

}  // namespace frahm::studies
