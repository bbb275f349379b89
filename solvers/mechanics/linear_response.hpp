#pragma once

#include <Eigen/Core>

namespace frahm::periodic {

// x of (K - omega^2 M) x = f with a complex stiffness K, which holds the damping; all n x n, f of size n. Not
// finite at an undamped resonance.
Eigen::VectorXcd linear_response(const Eigen::MatrixXd& M, const Eigen::MatrixXcd& K, double omega,
                                 const Eigen::VectorXcd& f);

}  // namespace frahm::periodic
