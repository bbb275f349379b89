#pragma once

#include <limits>

namespace frahm {

// The value of a number that is not known or not defined.
inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The bound of what is not bounded, and the first value of a search for the least.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace frahm
