#pragma once

#include <vector>

#include "solvers/flow/flow.hpp"

namespace frahm::periodic {

// A change of mode: the event that ended the segment before it, and its outcome. Sensitivities, histories and
// the certificate read these data instead of deducing them from the modes on both sides.
struct Event {
  std::size_t segment = 0;   // the segment that it ends; the next one begins with it
  ContactMask arrived = 0;   // contacts whose velocity reached zero here and that now stick or slide back
  ContactMask released = 0;  // contacts that stuck before and now slide
  Eigen::Index bend = -1;    // the bend that ended the segment; then its guard's slope, and which guard it is
  bool bend_by_force = false;
  // Events of this instant at which the acceleration may jump: a held velocity arrives, a force falls from a
  // static limit, a bend's force jumps.
  int jumps = 0;
  // The contact that ended the segment; an arrival counts before a release (-1: none changed). Then the slope
  // of its guard function [m a step^2 or N a step], seen from inside the segment, and the side of the limit
  // that a force reached. Of an idle contact that shares the forces again it is the stuck force after it.
  Eigen::Index contact = -1;
  double slope = 0.0;
  double side = 1.0;

  // Whether a further event of this instant is the one to be recorded: the first of those at which the
  // acceleration may jump, else the first.
  bool is_to_record(bool may_jump) {
    const bool takes = jumps == 0 && (may_jump || (contact < 0 && bend < 0));
    jumps += may_jump ? 1 : 0;
    if (takes) contact = bend = -1;
    return takes;
  }
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
