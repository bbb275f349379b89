#include "solvers/algebra/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

#include "solvers/algebra/no_value.hpp"

namespace frahm::algebra {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A, /*computeEigenvectors=*/false);
  if (solver.info() != Eigen::Success) return Eigen::VectorXcd::Constant(A.rows(), kNone);
  return solver.eigenvalues();
}

}  // namespace frahm::algebra
