#pragma once

#include <Eigen/Core>

#include "solvers/flow/sizes.hpp"

// Linear algebra of stuck contacts, for any number of them.
namespace frahm::periodic {

// G^+ for a symmetric positive semidefinite G (m x m): lambda = G^+ b solves G lambda = b; if there are
// several, that of least sum (lambda_j / weight_j)^2. Rows and columns of weight 0 are left out (zero).
Eigen::MatrixXd weighted_pseudo_inverse(const Eigen::MatrixXd& G, const Eigen::VectorXd& weight);

// The inverse of a symmetric positive definite G.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& G);

}  // namespace frahm::periodic
