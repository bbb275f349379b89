#pragma once

#include <cmath>

// Limits of the length of a motion (trajectory.hpp, motion_sensitivity.hpp).
namespace frahm::transient {

// A number of steps without the rounding of the times between which they lie, where it is whole but for that.
inline double without_rounding(double steps) {
  constexpr double kRounding =
      1e-10;  // of a step; times are rounded to about 1e-14 of the last, steps a thousandth
  const double whole = std::round(steps);
  return whole > 0.0 && std::abs(steps - whole) <= kRounding ? whole : steps;
}

inline constexpr double kStepsAtOnce = 256.0;  // in memory: a few hundred kilobytes for a few masses
inline constexpr double kMostSteps = 1e7;      // some ten seconds of one core
inline constexpr const char* kTooManySteps =
    "it takes more than 10 million steps of the fastest oscillation of system or excitation";

}  // namespace frahm::transient
