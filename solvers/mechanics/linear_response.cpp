#include "solvers/mechanics/linear_response.hpp"

#include <Eigen/Dense>

namespace frahm::periodic {

Eigen::VectorXcd linear_response(const Eigen::MatrixXd& M, const Eigen::MatrixXcd& K, double omega,
                                 const Eigen::VectorXcd& f) {
  return (K - omega * omega * M).partialPivLu().solve(f);
}

}  // namespace frahm::periodic
