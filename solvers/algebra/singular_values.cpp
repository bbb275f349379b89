#include "solvers/algebra/singular_values.hpp"

#include <Eigen/SVD>

namespace frahm::algebra {

SingularValues singular_values(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixV()};
}

}  // namespace frahm::algebra
