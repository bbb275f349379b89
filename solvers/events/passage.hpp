#pragma once

#include <vector>

#include "solvers/flow/flow.hpp"

namespace frahm::periodic {

// A change of mode: all that happened at the instant that ended the segment before it. Sensitivities read
// from here whose guard was reached, and the rest from the instants and modes on both sides.
struct Event {
  std::size_t segment = 0;   // the segment that it ends; the next one begins with it
  ContactMask arrived = 0;   // contacts whose velocity reached zero here, to stick or to slide back
  ContactMask released = 0;  // contacts that stuck before and now slide
  ContactMask let_go = 0;    // contacts whose stuck force reached its limit here
  ContactMask at_place = 0;  // bends that came to their place
  ContactMask by_force = 0;  // bends whose force vanished, or pushes again
  // An idle contact that shares the forces again (-1: none), and the side of its limit at which it does.
  Eigen::Index shares = -1;
  double side = 1.0;
};

// Whether the tangent of a passage is followed. Of a large system that takes as long as many passages: its
// path may be recorded instead, along which the tangent can be followed later.
enum class Tangent { none, recorded, followed };

// The flow over a stretch of time from one state.
template <int N, int H>
struct Passage {
  typename Sizes<N, H>::State end;
  typename Sizes<N, H>::StateSquare tangent;  // d end / d start, product of flow and saltation matrices
  bool has_tangent = false;                   // it was followed
  bool has_path = false;                      // recorded; of a large system only
  TangentPath path;
  std::vector<Segment<N, H>> segments;
  std::vector<Event> changes;  // between the segments, one fewer than segments
  double energy_scale = 0.0;   // of its start (Flow::energy_scale) [sqrt(J)]
  int events = 0;              // stops, releases, reversals and bends, also those without a change of mode
  int bends = 0;               // those of them that are no event of a contact
  double margin = 1.0;         // relative distance of the nearest event from a different outcome; 0 = grazing
  bool starts_at_event = false;   // a contact passes through rest at the very start, outside the tangent
  const char* failure = nullptr;  // why the passage could not be completed
};

// Contacts that slide in the mode `before` and stick, or slide back, in `after`. Contacts at rest and those
// without friction do not count: nothing changes for them.
template <int N, int H>
ContactMask arrived_between(const Flow<N, H>& flow, const Mode<N, H>& before, const Mode<N, H>& after) {
  ContactMask arrived = 0;
  for (Eigen::Index j = 0; j < flow.equations().contacts(); ++j) {
    if (flow.rests(before, j) || flow.equations().limit[j] == 0.0) continue;
    if (contains(after.stuck, j) || after.sign(j) != before.sign(j)) arrived |= bit(j);
  }
  return arrived;
}

// Contacts that rest throughout.
template <int N, int H>
ContactMask stuck_throughout(const Flow<N, H>& flow, const Passage<N, H>& passage) {
  ContactMask stuck = ~ContactMask{0};
  for (const Segment<N, H>& segment : passage.segments) stuck &= flow.at_rest(flow.mode(segment.mode));
  return stuck;
}

}  // namespace frahm::periodic
