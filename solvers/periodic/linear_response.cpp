#include "solvers/periodic/linear_response.hpp"

#include <Eigen/Dense>

namespace frahm::periodic {

Eigen::VectorXcd linear_response(const Eigen::MatrixXd& M, const Eigen::MatrixXd& C, const Eigen::MatrixXd& K,
                                 double omega, const Eigen::VectorXcd& f) {
  Eigen::MatrixXcd dynamic_stiffness(K.rows(), K.cols());
  dynamic_stiffness.real() = K - omega * omega * M;
  dynamic_stiffness.imag() = omega * C;
  return dynamic_stiffness.partialPivLu().solve(f);
}

}  // namespace frahm::periodic
