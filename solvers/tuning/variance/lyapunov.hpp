#pragma once

#include <Eigen/Core>

#include "solvers/algebra/schur.hpp"

namespace frahm::tuning {

// Solves Lyapunov equations of one matrix A (N x N), every eigenvalue of which must have a negative real
// part. Source: R. H. Bartels, G. W. Stewart, Commun. ACM 15 (1972) 820-826, with the complex Schur form.
class Lyapunov {
 public:
  explicit Lyapunov(const Eigen::MatrixXd& A);

  // Largest real part of an eigenvalue, over the largest modulus: < 0 where the equations have a solution.
  double abscissa() const;

  Eigen::MatrixXd solve(const Eigen::MatrixXd& W) const;          // P of A P + P A^T + W = 0, W symmetric
  Eigen::MatrixXd solve_adjoint(const Eigen::MatrixXd& W) const;  // Q of A^T Q + Q A + W = 0, W symmetric

 private:
  Eigen::MatrixXd A_;
  algebra::Schur schur_;
};

}  // namespace frahm::tuning
