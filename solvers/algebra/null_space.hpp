#pragma once

#include <Eigen/Core>

namespace frahm::algebra {

// A basis, n x k in columns, of all x with A x = 0; A is m x n. Without columns where there is only x = 0;
// all directions where A has no rows.
Eigen::MatrixXd null_space(const Eigen::MatrixXd& A);

}  // namespace frahm::algebra
