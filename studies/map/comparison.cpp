#include "studies/map/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "studies/provenance/result_variables.hpp"

namespace frahm::studies {
namespace {

using mechanics::ForceLaw;
using periodic::QuantityDescription;

std::string shown_text(periodic::OrbitsWanted::Show show) {
  switch (show) {
    case periodic::OrbitsWanted::Show::largest:
      return "for the largest response found";
    case periodic::OrbitsWanted::Show::smallest:
      return "for the smallest response found";
    case periodic::OrbitsWanted::Show::up:
      return "as the frequency rises";
    case periodic::OrbitsWanted::Show::down:
      return "as the frequency falls";
  }
  return "";
}

// "under the arctan law", for the long names of variables.
std::string circumstance(const Comparison& comparison) {
  if (comparison.show) return shown_text(*comparison.show);
  if (comparison.taylor_order > 0)
    return fmt::format("with the crank cut at order {}", comparison.taylor_order);
  return comparison.law == ForceLaw::arctan ? "under the arctan law" : "under the exact law";
}

QuantityDescription described(const Named& named, const std::string& unit) {
  return {.name = named.name(), .unit = unit, .long_name = named.meaning(), .flags = {}};
}

}  // namespace

bool meets_smooth_laws(const Study& study) {
  return mechanics::has_smooth_law(study.network) ||
         (study.sweep() && study.sweep()->comparison && mechanics::has_smooth_law(compared_network(study)));
}

mechanics::Network compared_network(const Study& study) {
  const Comparison& comparison = *study.sweep()->comparison;
  mechanics::Network network = study.network;
  if (comparison.show) return network;
  if (comparison.taylor_order == 0) {
    for (mechanics::Element& element : network.elements) {
      if (mechanics::kind_of(element).can_be_smoothed()) element.law = comparison.law;
    }
    return network;
  }
  for (mechanics::Excitation& excitation : network.excitations) {
    if (excitation.kind != mechanics::ExcitationKind::crank) continue;
    excitation.taylor_order = comparison.taylor_order;
    excitation.even_orders = comparison.taylor_order / 2;
  }
  return network;
}

StudyValues compared_values(const Study& study) {
  const Comparison& comparison = *study.sweep()->comparison;
  StudyValues values = study.values;
  if (comparison.show || comparison.taylor_order > 0 || comparison.law == ForceLaw::exact) return values;
  for (std::size_t e = 0; e < study.network.elements.size(); ++e) {
    const mechanics::ElementKind& kind = mechanics::kind_of(study.network.elements[e]);
    const auto keys = kind.values();
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (kind.can_be_smoothed() && keys[i] == &kind.slope) values.elements[i][e] = comparison.slope;
  }
  return values;
}

periodic::OrbitsWanted compared_orbits(const Study& study) {
  periodic::OrbitsWanted wanted = study.orbits_wanted();
  wanted.show = study.sweep()->comparison->show.value_or(wanted.show);
  return wanted;
}

std::vector<periodic::Quantity> compared_quantities(const Study& study) {
  std::vector<periodic::Quantity> result = study.sweep()->comparison->quantities;
  result.push_back({periodic::Measure::status, 0});
  return result;
}

std::vector<QuantityDescription> compared_variables(const Study& study) {
  const std::string how = circumstance(*study.sweep()->comparison);
  std::vector<QuantityDescription> result;
  for (const periodic::Quantity& quantity : study.sweep()->comparison->quantities) {
    const QuantityDescription own = periodic::describe(quantity, study.network, study.dimensionless);
    result.push_back(described({"*_compared", {own.name}, {own.long_name, how}}, own.unit));
    result.push_back(described({"*_difference", {own.name}, {own.name, how}}, "1"));
  }
  QuantityDescription status =
      periodic::describe({periodic::Measure::status, 0}, study.network, study.dimensionless);
  const Named compared("*_compared", {status.name}, {status.long_name, how});
  status.name = compared.name();
  status.long_name = compared.meaning();
  result.push_back(status);
  return result;
}

std::optional<periodic::Quantity> size_of_compared(const periodic::Quantity& quantity) {
  if (quantity.measure != periodic::Measure::mean) return std::nullopt;
  return periodic::Quantity{periodic::Measure::rms, quantity.index};
}

void compare(std::span<const double> own, std::span<const double> sizes, std::span<const double> other,
             std::span<double> variables) {
  constexpr double kRounding = 1e-11;  // of a mean, over its root mean square
  for (std::size_t i = 0; i < own.size(); ++i) {
    const double size = std::abs(own[i]);
    variables[2 * i] = other[i];
    variables[2 * i + 1] = size > kRounding * sizes[i] ? std::abs(own[i] - other[i]) / size : kNone;
  }
  variables.back() = other.back();
}

}  // namespace frahm::studies
