#include "solvers/algebra/null_space.hpp"

#include <Eigen/LU>

namespace frahm::algebra {

Eigen::MatrixXd null_space(const Eigen::MatrixXd& A) {
  if (A.rows() == 0) return Eigen::MatrixXd::Identity(A.cols(), A.cols());
  const Eigen::FullPivLU<Eigen::MatrixXd> factor(A);
  if (factor.dimensionOfKernel() == 0) return Eigen::MatrixXd(A.cols(), 0);  // Eigen returns one zero column
  return factor.kernel();
}

}  // namespace frahm::algebra
