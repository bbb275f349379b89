#pragma once

#include <string>
#include <vector>

#include "solvers/events/passage.hpp"
#include "solvers/orbits/closing.hpp"

namespace frahm::periodic {

// How the search for a periodic response ended. Result files store the numbers.
enum class Status {
  not_computed = 0,
  ok = 1,
  grazing =
      2,  // a contact's velocity or force only touches: the response is right, its derivative does not exist
  unbounded = 3,  // an undamped resonance that friction cannot hold: no periodic response exists
  failed = 4,
  several = 5,  // laws that are not monotone: more than one stable orbit was found, one of which is reported
  not_periodic = 6,  // the same: no stable orbit was found among the multiples of the period that were tried
};

// Whether there is a response, which is right.
inline bool has_response(Status status) {
  return status == Status::ok || status == Status::grazing || status == Status::several;
}

// Below this relative margin of its nearest event an orbit counts as grazing.
inline constexpr double kGrazing = 1e-9;

// A periodic orbit in the units of StepEquations (time in steps), from its section over one period, or over
// half a period where the orbit repeats with the opposite sign.
template <int N, int H>
struct Orbit {
  using S = Sizes<N, H>;

  Status status = Status::not_computed;
  std::string reason;        // why it failed; empty otherwise
  typename S::State z;       // at the section
  double section = 0.0;      // omega t of the section [rad]
  bool half_period = false;  // the passage covers half a period: x(t + T/2) = -x(t)
  Passage<N, H> passage;
  ContactMask stuck_throughout = 0;
  Closing closing;              // modulo what it closes
  double residual = 0.0;        // of the periodic condition, relative, energy norm
  double error_bound = 0.0;     // of every node's displacement at every time [m]; NaN where none holds
  double contraction = 0.0;     // L, energy norm of the map's derivative
  double floquet_radius = 0.0;  // largest Floquet multiplier of the full period, of what can move
  int newton_iterations = 0;
  int passages = 0;  // of the flow that the search took

  int multiple = 1;    // of the forcing's period, that the orbit takes
  int coexisting = 1;  // stable orbits that were found
  int unsettled = 0;   // starts of the search whose motions came to no stable orbit

  double sign() const { return half_period ? -1.0 : 1.0; }
  bool is_found() const { return has_response(status); }
  // Stable, as a linear motion next to it shows. The multipliers +1 of contacts that rest do not count.
  bool is_stable() const { return floquet_radius < 1.0; }
};

}  // namespace frahm::periodic
