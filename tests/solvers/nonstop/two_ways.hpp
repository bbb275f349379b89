#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "solvers/quantities/quantity.hpp"

// The same response found in two ways: how far its quantities are apart.
namespace frahm::periodic {

inline double value_of(Measure measure, std::size_t index, const std::vector<Quantity>& quantities,
                       const std::vector<double>& values) {
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (quantities[i].measure == measure && quantities[i].index == index) return values[i];
  }
  return 0.0;
}

// Figures of the computation, which tell the two ways apart.
inline bool is_of_computation(Measure measure) {
  return measure == Measure::residual || measure == Measure::energy_balance ||
         measure == Measure::newton_iterations || measure == Measure::error_bound;
}

// Relative to the value; of a mean or a component to the peak it is part of; of a phase lag [rad] times the
// part of the peak that has this phase; of an element's energy to what all elements dissipate; of shares and
// multipliers to 1. Infinite where one way has no value. a: of all_quantities().
inline double difference(std::size_t i, const std::vector<Quantity>& quantities, const std::vector<double>& a,
                         const std::vector<double>& b) {
  if (a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]))) return 0.0;
  const auto [measure, index, side] = quantities[i];
  const double apart = std::abs(a[i] - b[i]);
  const auto of = [&, index = index](Measure other) { return value_of(other, index, quantities, a); };
  double result = apart / std::abs(a[i]);
  if (measure == Measure::mean || measure == Measure::harmonic) result = apart / of(Measure::peak);
  if (measure == Measure::energy) result = apart / value_of(Measure::energy_input, 0, quantities, a);
  if (measure == Measure::energy_share || measure == Measure::stuck_fraction ||
      measure == Measure::floquet_radius)
    result = apart;
  if (is_angle(measure)) result = std::abs(std::remainder(a[i] - b[i], 2.0 * std::numbers::pi));
  if (measure == Measure::phase) result *= of(Measure::harmonic) / of(Measure::peak);
  return std::isnan(result) ? INFINITY : result;
}

}  // namespace frahm::periodic
