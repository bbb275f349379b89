#include "solvers/algebra/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace frahm::algebra {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
  return A.eigenvalues();
}

}  // namespace frahm::algebra
