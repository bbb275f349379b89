#pragma once

#include <Eigen/Core>

namespace frahm::algebra {

// A = U T U^H of an n x n matrix A, with U unitary and T upper triangular, the eigenvalues on its diagonal.
struct Schur {
  Eigen::MatrixXcd U, T;
};

Schur schur(const Eigen::MatrixXd& A);

}  // namespace frahm::algebra
