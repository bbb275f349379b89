#pragma once

#include <Eigen/Core>

namespace frahm::periodic {

struct BoxMinimum {
  Eigen::VectorXd lambda;
  bool found = false;  // false: too many changes of the active set; lambda is the last iterate
};

// The lambda with lower <= lambda <= upper that minimises  1/2 lambda^T G lambda - c^T lambda,
// G symmetric, positive semidefinite, m x m; of several minima that of least sum (lambda_j / weight_j)^2
// over the free components.
//
// With G = W^T M^-1 W and c the relative accelerations without friction these are the friction forces of
// contacts at rest (principle of least constraint; the dual of the linear complementarity problem of Coulomb
// friction, Glocker, Set-Valued Force Laws, 2001, ch. 9). With G = W^T K^-1 W it is the rest position of
// least energy. An active-set method: finite, and exact on its final set.
BoxMinimum box_minimum(const Eigen::MatrixXd& G, const Eigen::VectorXd& c, const Eigen::VectorXd& lower,
                       const Eigen::VectorXd& upper, const Eigen::VectorXd& weight);

}  // namespace frahm::periodic
