#include "solvers/flow/constraints.hpp"

#include <Eigen/Dense>

namespace frahm::periodic {
namespace {

// Directions whose singular value is below this part of the largest depend on the others.
constexpr double kDependent = 1e-11;

}  // namespace

Eigen::MatrixXd weighted_pseudo_inverse(const Eigen::MatrixXd& G, const Eigen::VectorXd& weight) {
  const Eigen::VectorXd size =
      (weight.array() > 0.0).select(G.diagonal().cwiseSqrt().cwiseInverse(), 0.0).matrix();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(kDependent);
  // Directions that do not depend on one another have one answer, whatever the weights, which may be of very
  // different size.
  solver.compute(size.asDiagonal() * G * size.asDiagonal());
  const bool independent = solver.rank() == (weight.array() > 0.0).count();
  if (independent) return size.asDiagonal() * solver.pseudoInverse() * size.asDiagonal();
  solver.compute(weight.asDiagonal() * G * weight.asDiagonal());
  return weight.asDiagonal() * solver.pseudoInverse() * weight.asDiagonal();
}

Eigen::MatrixXd projector_off(const Eigen::MatrixXd& A, const Eigen::MatrixXd& W) {
  const Eigen::MatrixXd A_inverse_W = A.llt().solve(W);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> gram;
  gram.setThreshold(kDependent);
  gram.compute(W.transpose() * A_inverse_W);
  return Eigen::MatrixXd::Identity(A.rows(), A.rows()) - A_inverse_W * gram.solve(W.transpose());
}

Eigen::MatrixXd cholesky_root(const Eigen::MatrixXd& A) {
  return A.llt().matrixU();
}

}  // namespace frahm::periodic
