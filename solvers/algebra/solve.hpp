#pragma once

#include <Eigen/Core>

namespace frahm::algebra {

// Solves with a regular n x n matrix A, by elimination with row pivots.
Eigen::VectorXd solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);     // x of A x = b, n
Eigen::VectorXcd solve(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b);  // the same
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);

// Solves with a symmetric, positive definite n x n matrix A = U^T U, by Cholesky's decomposition.
Eigen::VectorXd solve_positive(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);  // x of A x = b, n
Eigen::MatrixXd solve_positive(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);  // X of A X = B, n x k
Eigen::MatrixXd upper_root(const Eigen::MatrixXd& A);                                // U, n x n

}  // namespace frahm::algebra
