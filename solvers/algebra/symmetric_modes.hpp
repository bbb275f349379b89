#pragma once

#include <Eigen/Core>

namespace frahm::algebra {

// Eigenvalues and eigenvectors of symmetric n x n matrices.
struct SymmetricModes {
  Eigen::VectorXd values;   // n, ascending
  Eigen::MatrixXd vectors;  // n x n, in columns
};

// A v = lambda v; the vectors are of length 1.
SymmetricModes symmetric_modes(const Eigen::MatrixXd& A);

// K v = lambda M v with M positive definite; the vectors are orthogonal with v^T M v = 1.
SymmetricModes symmetric_modes(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M);

// The values alone, n.
Eigen::VectorXd symmetric_values(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M);

}  // namespace frahm::algebra
