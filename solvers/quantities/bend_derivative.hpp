#pragma once

#include "solvers/flow/flow.hpp"

// The derivatives of what bends (laws/bend.hpp), along a change of the network's values; time is counted in
// steps. by: the derivatives of the bends' numbers and of p^T y(t), in the layout of StepBends.
namespace frahm::periodic {

// The change of a bend's force beyond its place at a given state and time:
//   F = k (b^T q + p^T y - D) + c (b^T v + p^T y'),   or  c (b^T v + p^T y' - D) of a velocity
template <int N, int H>
struct BendForceDerivative {
  using S = Sizes<N, H>;
  Eigen::Matrix<double, 1, N> of_displacement, of_velocity;  // dk b^T [N/m], dc b^T
  typename S::OscillatorRow of_oscillators;                  // [N]

  BendForceDerivative(const StepBends<N, H>& bends, const StepBends<N, H>& by, Eigen::Index j)
      : of_displacement(by.stiffness[j] * bends.B.col(j).transpose()),
        of_velocity(by.damping[j] * bends.B.col(j).transpose()) {
    const bool is_of_velocity = contains(bends.of_velocity, j);
    const double factor = is_of_velocity ? bends.damping[j] : bends.stiffness[j];
    const double factor_by = is_of_velocity ? by.damping[j] : by.stiffness[j];
    of_oscillators = bends.damping[j] * by.motion_velocity.row(j);
    of_oscillators += by.damping[j] * bends.motion_velocity.row(j);
    of_oscillators += bends.stiffness[j] * by.motion.row(j) + by.stiffness[j] * bends.motion.row(j);
    of_oscillators[0] -= factor * by.place[j] + factor_by * bends.place[j];
  }
};

// For its force [N], where the state x changes by `delta`, time held.
template <int N, int H>
double bend_force_derivative(const StepBends<N, H>& bends, const StepBends<N, H>& by, const Instant<N, H>& x,
                             const typename Sizes<N, H>::State& delta, Eigen::Index j) {
  const Eigen::Index n = bends.B.rows();
  const BendForceDerivative<N, H> force(bends, by, j);
  return bends.stiffness[j] * bends.B.col(j).dot(delta.head(n)) +
         bends.damping[j] * bends.B.col(j).dot(delta.segment(n, n)) + force.of_displacement.dot(x.z.head(n)) +
         force.of_velocity.dot(x.z.segment(n, n)) + force.of_oscillators.dot(x.u);
}

// For u - D [m], or u' - D of a velocity.
template <int N, int H>
double bend_place_derivative(const StepBends<N, H>& bends, const StepBends<N, H>& by, const Instant<N, H>& x,
                             const typename Sizes<N, H>::State& delta, Eigen::Index j) {
  const Eigen::Index n = bends.B.rows();
  const auto b = bends.B.col(j);
  if (contains(bends.of_velocity, j))
    return b.dot(delta.segment(n, n)) + by.motion_velocity.row(j).dot(x.u) - by.place[j];
  return b.dot(delta.head(n)) + by.motion.row(j).dot(x.u) - by.place[j];
}

}  // namespace frahm::periodic
