#include "solvers/orbits/rest_directions.hpp"

#include "solvers/flow/constraints.hpp"

namespace frahm::periodic {

void keep_balanced(const Eigen::MatrixXd& along, RestDirections& rest) {
  if (along.isZero(0.0)) return;
  rest.balanced = mechanics::unstrained(along);
  rest.E = (rest.E * rest.balanced).eval();
  rest.L = (rest.L * rest.balanced).eval();
}

Eigen::MatrixXd shift_per_kept(const RestDirections& rest) {
  if (rest.E.cols() == 0) return rest.E;
  const Eigen::MatrixXd G = rest.L.transpose() * rest.E;
  return rest.E * weighted_pseudo_inverse(G, Eigen::VectorXd::Ones(G.rows()));
}

Eigen::MatrixXd shift_projector(const RestDirections& rest) {
  return shift_per_kept(rest) * rest.L.transpose();
}

}  // namespace frahm::periodic
