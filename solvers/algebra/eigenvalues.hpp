#pragma once

#include <Eigen/Core>

namespace frahm::algebra {

// The n eigenvalues of an n x n matrix.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

}  // namespace frahm::algebra
