#pragma once

#include <Eigen/Core>

namespace frahm::algebra {

// The n eigenvalues of an n x n matrix; kNone where they are not found, as of one that is not finite.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

}  // namespace frahm::algebra
