#pragma once

#include <Eigen/Core>

namespace frahm::algebra {

// The shortest x, n, of all that minimise |A x - b|; A is m x n, of any rank.
Eigen::VectorXd shortest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

// The same for every column of B, m x k; the result is n x k.
Eigen::MatrixXd shortest_solutions(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

// The matrix, n x m, that maps b to that x.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);

}  // namespace frahm::algebra
