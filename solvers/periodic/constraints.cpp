#include "solvers/periodic/constraints.hpp"

#include <Eigen/Dense>

namespace frahm::periodic {
namespace {

// Directions whose singular value is below this part of the largest depend on the others.
constexpr double kDependent = 1e-11;

}  // namespace

Eigen::MatrixXd weighted_pseudo_inverse(const Eigen::MatrixXd& G, const Eigen::VectorXd& weight) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> scaled;
  scaled.setThreshold(kDependent);
  scaled.compute(weight.asDiagonal() * G * weight.asDiagonal());
  return weight.asDiagonal() * scaled.pseudoInverse() * weight.asDiagonal();
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
