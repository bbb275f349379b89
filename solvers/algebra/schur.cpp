#include "solvers/algebra/schur.hpp"

#include <Eigen/Eigenvalues>

namespace frahm::algebra {

Schur schur(const Eigen::MatrixXd& A) {
  const Eigen::ComplexSchur<Eigen::MatrixXd> solver(A);
  return {solver.matrixU(), solver.matrixT()};
}

}  // namespace frahm::algebra
