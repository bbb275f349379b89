#pragma once

#include "solvers/flow/flow.hpp"
#include "solvers/orbits/repeatable_numbers.hpp"

namespace frahm::periodic {

// A state of this reach [m] in all directions, the same for the same index at every run.
template <int N, int H>
typename Sizes<N, H>::State scattered(const Flow<N, H>& flow, int index, double reach) {
  const StepEquations<N, H>& eq = flow.equations();
  const Eigen::Index n = eq.masses();
  RepeatableNumbers numbers(index);
  typename Sizes<N, H>::State z;
  z.setZero(eq.states());
  for (Eigen::Index i = 0; i < n; ++i) z[i] = reach * numbers.next();
  for (Eigen::Index i = 0; i < n; ++i) z[n + i] = reach * flow.fundamental_rate() * numbers.next();
  return z;
}

// A change of a state in such a direction, of this share of its size in the energy norm.
template <int N, int H>
typename Sizes<N, H>::State disturbance(const Flow<N, H>& flow, const typename Sizes<N, H>::State& z,
                                        double share, int index) {
  const typename Sizes<N, H>::State by = scattered(flow, index, 1.0);
  return by * (share * flow.energy_scale(z) / flow.equations().energy_norm(by));
}

}  // namespace frahm::periodic
