#pragma once

#include <Eigen/Core>

namespace frahm::algebra {

// Singular values of A = U diag(values) V^T, m x n, with k = min(m, n).
struct SingularValues {
  Eigen::VectorXd values;  // k, descending
  Eigen::MatrixXd V;       // n x k
};

SingularValues singular_values(const Eigen::MatrixXd& A);

}  // namespace frahm::algebra
