#pragma once

#include "solvers/laws/bend.hpp"

namespace frahm::laws {

// A stop of stiffness k and damping c at the clearance D, which can only push: contact begins where u reaches
// D, and ends where k (u - D) + c u' falls to zero. With damping that is before u has returned to D; until
// then the stop is free, and takes hold again if the force it would have rises above zero. Without damping
// contact ends at D. With damping the force jumps by c u' where contact begins.
inline constexpr Bend elastic_stop{.name = "elastic stop", .of_velocity = false, .pulls = false};

}  // namespace frahm::laws
