#pragma once

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::mechanics {

// The derivative of a LinearSystem along a change of the network's values: every number of `derivative` is
// the derivative of that of `system`, laid out alike (its orders are copied; its W, D and laws, which no
// value changes, are left empty).
// values: those of which `assembly` made `system`, or what the same motion is over several periods
// (orbits/period_multiple.hpp).  direction: their derivative, .omega and .hysteretic_omega included, in the
// layout of NetworkValues; an empty `second`, `bends` or `damping` means zeros. The series of a crank's even
// orders is cut at the same order as that of the displacement.
void differentiate(const Assembly& assembly, const NetworkValues& values, const NetworkValues& direction,
                   const LinearSystem& system, LinearSystem& derivative);

// The same for masses, elements and the structure's damping alone: nothing of the excitation is touched.
void differentiate_matrices(const Assembly& assembly, const NetworkValues& values,
                            const NetworkValues& direction, const LinearSystem& system,
                            LinearSystem& derivative);

}  // namespace frahm::mechanics
