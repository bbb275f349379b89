#pragma once

#include "solvers/laws/bend.hpp"

namespace frahm::laws {

// A point of a spring's table, where its stiffness changes by k (of either sign).
inline constexpr Bend spring_bend{.name = "spring bend", .of_velocity = false, .pulls = true};

}  // namespace frahm::laws
