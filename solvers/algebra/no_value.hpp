#pragma once

#include <limits>

namespace frahm {

// What a number is where there is none: not known, or not defined.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// A bound where there is none, and the first value of a search for the least.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace frahm
