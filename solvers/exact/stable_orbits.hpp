#pragma once

#include <vector>

#include "solvers/flow/flow.hpp"

namespace frahm::periodic {

template <int N, int H>
struct StableOrbit {
  std::vector<typename Sizes<N, H>::State> returns;  // its states at phase 0, after each period
  double peak = 0.0;                                 // of the first mass [m]

  int multiple() const { return static_cast<int>(returns.size()); }  // of the forcing's period
};

// What a search has found at one point.
template <int N, int H>
struct StableOrbits {
  std::vector<StableOrbit<N, H>> stable;
  bool found_unstable = false;
  int passages = 0, newton_iterations = 0;
  double step = 0.0;  // [s], in which the states count the time
};

}  // namespace frahm::periodic
