#pragma once

#include <Eigen/Core>

namespace frahm::periodic {

// x of (K + i omega C - omega^2 M) x = f; all n x n, f of size n. Not finite at an undamped resonance.
Eigen::VectorXcd linear_response(const Eigen::MatrixXd& M, const Eigen::MatrixXd& C, const Eigen::MatrixXd& K,
                                 double omega, const Eigen::VectorXcd& f);

}  // namespace frahm::periodic
