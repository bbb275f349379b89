#pragma once

#include "solvers/laws/law.hpp"

namespace frahm::laws {

// Dry friction, lambda in F Sgn(u'), Sgn(0) = [-1, 1]: static limit and kinetic force are equal.
// While the contact sticks, u' = 0 and lambda is the force needed for this, |lambda| <= F. The forces of all
// such contacts at rest follow together from one convex problem (events/transition.hpp).
inline constexpr Law coulomb{.name = "coulomb", .holds_velocity = true, .merges = true};

}  // namespace frahm::laws
