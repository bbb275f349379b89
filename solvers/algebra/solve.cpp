#include "solvers/algebra/solve.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace frahm::algebra {

Eigen::VectorXd solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.partialPivLu().solve(b);
}

Eigen::VectorXcd solve(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b) {
  return A.partialPivLu().solve(b);
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& A) {
  return A.inverse();
}

Eigen::VectorXd solve_positive(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  return A.llt().solve(b);
}

Eigen::MatrixXd solve_positive(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.llt().solve(B);
}

Eigen::MatrixXd upper_root(const Eigen::MatrixXd& A) {
  return A.llt().matrixU();
}

}  // namespace frahm::algebra
