#pragma once

#include <span>
#include <utility>
#include <vector>

#include "solvers/flow/flow.hpp"
#include "solvers/orbits/known_orbit.hpp"

namespace frahm::periodic {

// Contacts that stick and bends that act, one after the other.
using Sequence = std::vector<std::pair<ContactMask, ContactMask>>;

template <int N, int H>
struct StableOrbit {
  std::vector<typename Sizes<N, H>::State> returns;  // its states at phase 0, after each period
  double peak = 0.0;                                 // of the first mass [m]
  ContactMask stuck_throughout = 0;
  Sequence sequence{};

  int multiple() const { return static_cast<int>(returns.size()); }  // of the forcing's period
};

// What a search has found at one point.
template <int N, int H>
struct StableOrbits {
  std::vector<StableOrbit<N, H>> stable;
  std::vector<typename Sizes<N, H>::State> unsettled;  // where motions were given up that came near no orbit
  const char* failure = nullptr;                       // why nothing more is followed
  int not_followed = 0;                                // starts, after a failure
  bool found_unstable = false;
  bool large_ones_grow = false;  // motions, at a resonance (is_unbounded)
  int passages = 0, newton_iterations = 0;
  double step = 0.0;  // [s], in which the states count the time
  Eigen::Index masses = 0;

  int starts_unsettled() const { return static_cast<int>(unsettled.size()) + not_followed; }
};

// Starts of a search.
template <int N, int H>
StableOrbits<N, H> stable_orbits(std::span<const KnownOrbit> known) {
  StableOrbits<N, H> orbits;
  orbits.step = 1.0;
  for (const KnownOrbit& each : known) {
    StableOrbit<N, H>& orbit = orbits.stable.emplace_back();
    orbit.returns.assign(static_cast<std::size_t>(each.multiple), each.state);
  }
  return orbits;
}

template <int N, int H>
std::vector<KnownOrbit> known_orbits(const StableOrbits<N, H>& orbits) {
  std::vector<KnownOrbit> known;
  for (const StableOrbit<N, H>& orbit : orbits.stable) {
    known.push_back({orbit.returns.front(), orbit.multiple()});
    Eigen::VectorXd& z = known.back().state;
    z.segment(orbits.masses, orbits.masses) /= orbits.step;
  }
  return known;
}

}  // namespace frahm::periodic
