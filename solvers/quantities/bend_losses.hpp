#pragma once

#include <vector>

#include "solvers/flow/linear_form.hpp"
#include "solvers/quantities/integrals.hpp"

namespace frahm::periodic {

// The work that goes into each bend over the orbit's steps [J]: the integral of its force times its velocity
// while it is beyond its place. What a spring has taken it gives back within a period, so over one it is what
// the bend dissipates: of one without damping exactly nothing.
template <int N, int H>
std::vector<double> bend_losses(OrbitSteps<N, H>& orbit, const Flow<N, H>& flow, const Forms<N, H>& forms,
                                bool half_period) {
  const Eigen::Index count = flow.equations().bends.count();
  std::vector<double> loss(static_cast<std::size_t>(count), 0.0);
  if (count == 0) return loss;
  const double seconds = (half_period ? 2.0 : 1.0) * flow.equations().step;
  for (PassageStep<N, H>& step : orbit.steps()) {
    const ContactMask beyond = flow.mode(step.mode).beyond;
    for (Eigen::Index j = 0; beyond != 0 && j < count; ++j) {
      if (!contains(beyond, j) || flow.equations().bends.damping[j] == 0.0) continue;
      const Expansion<N, H>& x = orbit.expand(step);
      const Polynomial force = forms.bend_force(j).polynomial(x),
                       velocity = forms.bend_velocity(j).polynomial(x);
      for (int node = 0; node < kNodes; ++node) {
        const double at = kNodeAt[node] * step.length;
        loss[static_cast<std::size_t>(j)] +=
            seconds * step.length * kNodeWeight[node] * evaluate(force, at) * evaluate(velocity, at);
      }
    }
  }
  return loss;
}

}  // namespace frahm::periodic
