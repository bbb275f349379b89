#pragma once

#include <Eigen/Core>

namespace frahm::algebra {

// Of an n x n matrix, n.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

}  // namespace frahm::algebra
