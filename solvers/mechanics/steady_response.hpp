#pragma once

#include <Eigen/Core>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::mechanics {

// The steady state (q [m], q' [m/s], s [N]) of a system at omega t = `phase`, with no contact forces. For
// each harmonic, Omega = order omega,
//   (K + i Omega C - Omega^2 M) X + D S = f,   (i Omega + rate) S = k i Omega (D^T X + p^T Y),
// and for the constant part K X = f_0. Internal forces of contacts are zero. Not finite at an undamped
// resonance.
Eigen::VectorXd steady_response(const LinearSystem& system, double phase);

}  // namespace frahm::mechanics
