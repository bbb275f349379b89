#include "studies/reading/quantities/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace frahm::studies {

std::optional<std::size_t> Parameters::find(std::string_view name) const {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](auto& parameter) { return parameter.name == name; });
  if (found == list.end()) return std::nullopt;
  return static_cast<std::size_t>(found - list.begin());
}

std::vector<std::string> Parameters::names() const {
  std::vector<std::string> names;
  for (const Parameter& parameter : list) names.push_back(parameter.name);
  return names;
}

std::vector<double> Parameters::nominal() const {
  std::vector<double> values(list.size(), 0.0);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (const auto* number = std::get_if<double>(&list[i].definition)) values[i] = *number;
  }
  complete(std::span<double>(values));
  return values;
}

std::vector<std::size_t> Parameters::inputs_of(std::span<const std::size_t> reads) const {
  std::vector<bool> needed(list.size(), false);
  for (const std::size_t i : reads) needed[i] = true;
  // `derived` lists each parameter after those it reads: backwards, every reader comes before what it reads.
  for (auto i = derived.rbegin(); i != derived.rend(); ++i) {
    if (!needed[*i]) continue;
    needed[*i] = false;
    if (const auto* inner = std::get_if<Expression>(&list[*i].definition)) {
      for (const std::size_t j : inner->reads()) needed[j] = true;
    } else {
      needed[std::get<TableOf>(list[*i].definition).of] = true;
    }
  }
  std::vector<std::size_t> inputs;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (needed[i]) inputs.push_back(i);
  }
  return inputs;
}

double si_factor(const Parameter& parameter, const Unit& unit) {
  if (parameter.quantity) {
    try {
      return si_factor(unit, *parameter.quantity);
    } catch (const UnitError& error) {
      throw UnitError(error.rule(),
                      fmt::format("{}; the parameter is used as {}", error.what(), parameter.used_as));
    }
  }
  if (parameter.in_frequency && unit.counts_cycles()) return si_factor(unit, Quantity::angular_frequency);
  if (parameter.unit &&
      (parameter.unit->exponents != unit.exponents || parameter.unit->foreign != unit.foreign)) {
    throw UnitError(rules::wrong_dimension,
                    fmt::format("the unit \"{}\" is that of {}, but the parameter \"{}\" is given in \"{}\"",
                                unit.text, dimension_name(unit), parameter.name, parameter.unit->text));
  }
  if (unit.counts_cycles()) {
    throw UnitError(rules::ambiguous_unit,
                    fmt::format("the unit \"{}\" may count cycles or radians; write rad/s, rpm or cycle/s, "
                                "or no unit for SI (the "
                                "excitation frequency does not depend on \"{}\", which would settle it)",
                                unit.text, parameter.name));
  }
  return unit.scale;
}

double factor_of_label(const Parameters& parameters, const std::string& text, const Unit& unit) {
  const auto index = parameters.find(text);
  if (!index) return 1.0;
  const Parameter& parameter = parameters.list[*index];
  if (!parameter.unit && !parameter.unit_of_range && !parameter.quantity && !parameter.in_frequency)
    return 1.0;
  try {
    return si_factor(parameter, unit);
  } catch (const UnitError&) {  // of another dimension, which the check of dimensions tells
    return 1.0;
  }
}

}  // namespace frahm::studies
