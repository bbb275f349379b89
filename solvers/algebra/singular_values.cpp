#include "solvers/algebra/singular_values.hpp"

#include <Eigen/SVD>

// Of the small blocks: compiled in jacobi_svd_once.cpp, beside this file rather than after it.
extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;

namespace frahm::algebra {

SingularValues singular_values(const Eigen::MatrixXd& A) {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixV()};
}

}  // namespace frahm::algebra
