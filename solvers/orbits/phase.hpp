#pragma once

#include <cmath>
#include <numbers>

namespace frahm::periodic {

// The angle in [0, 2 pi); an angle within 1e-9 of 2 pi is 0.
inline double whole_turns_removed(double phase) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double angle = phase - kTurn * std::floor(phase / kTurn);
  return angle > kTurn - 1e-9 ? 0.0 : angle;
}

// The position of a phase on an orbit that is known from its section over one period, or over half a period
// after which it repeats with the opposite sign.
struct PlaceOnOrbit {
  double from_section;  // [rad], from 0 to the end of the known part
  double sign;          // of the motion there
};
inline PlaceOnOrbit place_on_orbit(double phase, double section, bool half_period) {
  const double known = (half_period ? 1.0 : 2.0) * std::numbers::pi;
  const double passages = std::floor((phase - section) / known);
  const bool odd = std::fmod(std::abs(passages), 2.0) == 1.0;
  return {phase - section - passages * known, half_period && odd ? -1.0 : 1.0};
}

}  // namespace frahm::periodic
