#pragma once

#include "solvers/laws/bend.hpp"

namespace frahm::laws {

// A point of a damper's table, where its damping changes by c (of either sign): rebound and bump of a shock
// absorber. As long as the whole characteristic rises, the element is monotone.
inline constexpr Bend damper_bend{.name = "damper bend", .of_velocity = true, .pulls = true};

}  // namespace frahm::laws
