#include "solvers/algebra/symmetric_modes.hpp"

#include <Eigen/Eigenvalues>

namespace frahm::algebra {

SymmetricModes symmetric_modes(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricModes symmetric_modes(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, M);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd symmetric_values(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M,
                                                                   Eigen::EigenvaluesOnly | Eigen::Ax_lBx)
      .eigenvalues();
}

}  // namespace frahm::algebra
