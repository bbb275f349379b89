#pragma once

// Limits of the length of a motion (trajectory.hpp, motion_sensitivity.hpp).
namespace frahm::transient {

inline constexpr double kStepsAtOnce = 256.0;  // in memory: a few hundred kilobytes for a few masses
inline constexpr double kMostSteps = 1e7;      // some ten seconds of one core
inline constexpr const char* kTooManySteps =
    "it takes more than 10 million steps of the fastest oscillation of system or excitation";

}  // namespace frahm::transient
