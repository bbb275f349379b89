#pragma once

#include <vector>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::periodic {

// Modes of a network with all friction sliding, or with every contact stuck.
struct LinearModes {
  std::vector<double> frequency;           // undamped, ascending [rad/s]; 0 where no spring holds the masses
  std::vector<double> damping;             // ratio of each; NaN of those of frequency 0
  std::vector<std::vector<double>> shape;  // displacement of each mass, largest 1
};
LinearModes linear_modes(const mechanics::Network& network, const mechanics::NetworkValues& values,
                         bool all_stuck, mechanics::FreeMasses free = mechanics::FreeMasses::refused);

// The lowest undamped frequency > 0 [rad/s] with all friction sliding; NaN where nothing oscillates.
double lowest_frequency(const mechanics::Network& network, const mechanics::NetworkValues& values,
                        mechanics::FreeMasses free);
// The same of given frequencies, ascending.
double lowest_frequency(const std::vector<double>& frequencies);

// Undamped frequencies [rad/s], ascending, and phi^T C phi / (2 omega phi^T M phi) of each mode phi; 0 and
// NaN of the free directions.
void modes_of(const mechanics::LinearSystem& system, std::vector<double>& frequency,
              std::vector<double>& damping);

// Their derivatives along `by`, the derivative of the system; NaN for modes of equal frequency.
void modes_derivative(const mechanics::LinearSystem& system, const mechanics::LinearSystem& by,
                      std::vector<double>& frequency, std::vector<double>& damping);

}  // namespace frahm::periodic
