#include "solvers/orbits/rest_position.hpp"

#include "solvers/events/box_minimum.hpp"

namespace frahm::periodic {

RestShift least_energy_shift(const Eigen::MatrixXd& K_inverse, const Eigen::MatrixXd& W,
                             const Eigen::VectorXd& q_mean, const Eigen::VectorXd& lower,
                             const Eigen::VectorXd& upper, const Eigen::VectorXd& limit) {
  const Eigen::MatrixXd G = W.transpose() * K_inverse * W;
  const Eigen::VectorXd delta = box_minimum(G, W.transpose() * q_mean, lower, upper, limit);
  RestShift shift{-(K_inverse * (W * delta)), false};
  for (Eigen::Index j = 0; j < delta.size(); ++j) {
    const double room = std::min(delta[j] - lower[j], upper[j] - delta[j]);
    if (room <= kGrazing * limit[j]) shift.at_limit = true;
  }
  return shift;
}

}  // namespace frahm::periodic
