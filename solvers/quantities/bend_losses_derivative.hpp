#pragma once

#include <vector>

#include "solvers/quantities/integrals.hpp"
#include "solvers/quantities/passage_sensitivity.hpp"

namespace frahm::periodic {

// A bend over a step: its force beyond its place and its velocity, with their derivatives along a direction.
// Velocities are of a step, so that the integral of the power over steps is the work.
template <int N, int H>
struct BendOverStep {
  Polynomial force, velocity, force_by, velocity_by;

  BendOverStep(const StepBends<N, H>& bends, const StepBends<N, H>& by, const Expansion<N, H>& x,
               const typename Sizes<N, H>::StatePolynomials& delta, Eigen::Index j) {
    const Eigen::Index n = bends.B.rows();
    const auto b = bends.B.col(j);
    const BendForceDerivative<N, H> change(bends, by, j);
    velocity = x.velocity(b) + x.u * bends.motion_velocity.row(j).transpose();
    velocity_by = delta.middleCols(n, n) * b + x.u * by.motion_velocity.row(j).transpose();
    force = bends.stiffness[j] * x.displacement(b) + bends.damping[j] * x.velocity(b) +
            x.u * bends.support_force(j).transpose();
    force_by = bends.stiffness[j] * (delta.leftCols(n) * b) + bends.damping[j] * (delta.middleCols(n, n) * b);
    force_by += x.displacement(change.of_displacement.transpose());
    force_by += x.velocity(change.of_velocity.transpose());
    force_by += x.u * change.of_oscillators.transpose();
  }

  double power(double at) const { return evaluate(force, at) * evaluate(velocity, at); }
  double power_by(double at) const {
    return evaluate(force_by, at) * evaluate(velocity, at) + evaluate(force, at) * evaluate(velocity_by, at);
  }
};

// The derivatives of bend_losses():  the integral of d(force x velocity), and the power at the ends that
// their events shift. orbit: its steps, expanded.  passage: the sensitivity over them.
template <int N, int H>
std::vector<double> bend_losses_derivative(const OrbitSteps<N, H>& orbit, const Flow<N, H>& flow,
                                           const PassageSensitivity<N, H>& passage, bool half_period) {
  const StepBends<N, H>&bends = flow.equations().bends, &by = passage.equations().bends;
  std::vector<double> loss(static_cast<std::size_t>(bends.count()), 0.0);
  const auto steps = orbit.steps();
  const auto is_beyond = [&](std::size_t i, Eigen::Index j) {
    return contains(flow.mode(steps[i].mode).beyond, j);
  };
  std::size_t changes = 0;
  for (std::size_t i = 0; i < steps.size() && bends.count() > 0; ++i) {
    const PassageStep<N, H>& step = steps[i];
    const bool is_after_change = i > 0 && steps[i - 1].ends_segment;
    const bool is_before_change = step.ends_segment && i + 1 < steps.size();
    changes += is_after_change ? 1 : 0;
    for (Eigen::Index j = 0; j < bends.count(); ++j) {
      if (!is_beyond(i, j) || (bends.damping[j] == 0.0 && by.damping[j] == 0.0)) continue;
      const BendOverStep<N, H> bend(bends, by, step.expansion, passage.polynomials(i), j);
      double work = 0.0;
      for (int node = 0; node < kNodes; ++node)
        work += step.length * kNodeWeight[node] * bend.power_by(kNodeAt[node] * step.length);
      if (is_after_change && !is_beyond(i - 1, j))
        work -= bend.power(0.0) * passage.shift_of_bend(changes - 1, j);
      if (is_before_change && !is_beyond(i + 1, j))
        work += bend.power(step.length) * passage.shift_of_bend(changes, j);
      loss[static_cast<std::size_t>(j)] += (half_period ? 2.0 : 1.0) * work;
    }
  }
  return loss;
}

}  // namespace frahm::periodic
