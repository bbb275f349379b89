#pragma once

#include <Eigen/Core>

namespace frahm::algebra {

// Eigenvalues and eigenvectors of an n x n matrix A = V diag(values) V^-1. Conjugate eigenvalues follow each
// other, the one above the real axis first. All are kNone where they are not found, as of a matrix that is not
// finite.
struct Spectrum {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;  // V, columns of length 1
  Eigen::MatrixXcd inverse;  // V^-1; not finite where A has no n eigenvectors
};
Spectrum spectrum(const Eigen::MatrixXd& A);

}  // namespace frahm::algebra
