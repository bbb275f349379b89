#pragma once

#include <string>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::periodic {

// Why a constant load drives free masses away faster and faster, so that there is no periodic response: the
// masses, the force and what holds them. Empty where velocities stay bounded, which they do if and only if
// there are constant forces lambda_j within the limits of the contacts, at rest, with
//   R_c^T (f_0 - sum_j w_j lambda_j) = 0,
// R_c the free directions along which no damper acts (of the maximal monotone sum that friction and load
// are: Brezis, Operateurs maximaux monotones, 1973, ch. 2). Where a stop may hold the masses nothing is said.
std::string runaway(const mechanics::Assembly& assembly, const mechanics::LinearSystem& system);

}  // namespace frahm::periodic
