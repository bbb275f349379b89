#pragma once

#include <Eigen/Core>
#include <vector>

namespace frahm::periodic {

// How contacts at rest share what they carry together.
struct LeastShares {
  Eigen::VectorXd lambda;           // [N]
  std::vector<Eigen::Index> bound;  // those that a bound keeps from their share, which carry the bound
};

// For all lambda with W lambda = W start and |lambda_j| <= bound_j that of least sum (lambda_j / weight_j)^2;
// there is one only. W: n x m, of any rank. start: within the bounds. A primal active-set method in the
// kernel of W: exact on its final set.
LeastShares least_shares(const Eigen::MatrixXd& W, const Eigen::VectorXd& start, const Eigen::VectorXd& bound,
                         const Eigen::VectorXd& weight);

}  // namespace frahm::periodic
