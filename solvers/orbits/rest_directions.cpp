#include "solvers/orbits/rest_directions.hpp"

#include "solvers/flow/constraints.hpp"

namespace frahm::periodic {

Eigen::MatrixXd shift_per_kept(const RestDirections& rest) {
  const Eigen::MatrixXd G = rest.L.transpose() * rest.E;
  return rest.E * weighted_pseudo_inverse(G, Eigen::VectorXd::Ones(G.rows()));
}

Eigen::MatrixXd shift_projector(const RestDirections& rest) {
  return shift_per_kept(rest) * rest.L.transpose();
}

}  // namespace frahm::periodic
