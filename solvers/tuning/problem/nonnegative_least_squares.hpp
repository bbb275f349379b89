#pragma once

#include <Eigen/Core>

namespace frahm::tuning {

// The x >= 0 that minimises |A x - b|^2 + sum_j (weight_j x_j)^2. A: m x n, of any rank; b: m; weight: n, >=
// 0. Columns that depend on others get x = 0. Source: C. L. Lawson, R. J. Hanson, Solving Least Squares
// Problems, 1974, ch. 23, algorithm NNLS.
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                          const Eigen::VectorXd& weight);

}  // namespace frahm::tuning
