#pragma once

#include <cstdint>

#include "solvers/flow/flow.hpp"

namespace frahm::periodic {

// A state of this reach [m] in all directions, the same for the same index at every run: a counter's bits,
// mixed (Steele, Lea, Flood, Proc. OOPSLA 2014, "SplitMix").
template <int N, int H>
typename Sizes<N, H>::State scattered(const Flow<N, H>& flow, int index, double reach) {
  const StepEquations<N, H>& eq = flow.equations();
  const Eigen::Index n = eq.masses();
  std::uint64_t counter = 0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(index);
  const auto between = [&] {  // -1 and 1
    std::uint64_t mixed = counter += 0x9E3779B97F4A7C15ULL;
    mixed = (mixed ^ (mixed >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94D049BB133111EBULL;
    return static_cast<double>((mixed ^ (mixed >> 31U)) >> 11U) * 0x1p-52 - 1.0;
  };
  typename Sizes<N, H>::State z;
  z.setZero(eq.states());
  for (Eigen::Index i = 0; i < n; ++i) z[i] = reach * between();
  for (Eigen::Index i = 0; i < n; ++i) z[n + i] = reach * flow.fundamental_rate() * between();
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
