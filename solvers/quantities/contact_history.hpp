#pragma once

#include "solvers/orbits/orbit.hpp"
#include "solvers/quantities/quantity.hpp"

namespace frahm::periodic {

// What a friction contact does in a period.
struct ContactHistory {
  int stops = 0;                  // stuck intervals of finite length
  int reversals = 0;              // changes of sliding direction, with or without a stop
  double stuck_fraction = 0.0;    // of the period
  double sliding_distance = 0.0;  // [m]
};

// `relative_displacement(z, steps since the section)` of the contact [m].
template <int N, int H, class RelativeDisplacement>
ContactHistory contact_history(const Orbit<N, H>& orbit, const Flow<N, H>& flow, Eigen::Index contact,
                               const RelativeDisplacement& relative_displacement) {
  const auto& segments = orbit.passage.segments;
  const double length = (orbit.half_period ? 0.5 : 1.0) * flow.equations().period;
  const double shortest_stop = 1e-9 * flow.equations().period;
  ContactHistory result;

  // The direction in which the contact slid before the section; after half a period it is the opposite.
  double direction = 0.0;
  for (const auto& segment : segments) {
    const Mode<N, H>& mode = flow.mode(segment.mode);
    if (!contains(mode.stuck, contact)) direction = orbit.sign() * mode.sign(contact);
  }
  if (direction == 0.0) {
    result.stuck_fraction = 1.0;
    return result;
  }

  // A stop that spans the section belongs to its arrival, at the end of the list.
  double stuck_at_start = 0.0;
  for (const auto& segment : segments) {
    if (!contains(flow.mode(segment.mode).stuck, contact)) break;
    stuck_at_start += segment.length;
  }
  double stuck = 0.0, stuck_so_far = 0.0;
  bool slid_before = stuck_at_start == 0.0;
  const auto end_stop = [&](double duration) {
    if (slid_before && duration > shortest_stop) ++result.stops;
  };
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Mode<N, H>& mode = flow.mode(segments[i].mode);
    if (contains(mode.stuck, contact)) {
      stuck += segments[i].length;
      stuck_so_far += segments[i].length;
      continue;
    }
    end_stop(stuck_so_far);
    stuck_so_far = 0.0;
    slid_before = true;
    if (mode.sign(contact) != direction) ++result.reversals;
    direction = mode.sign(contact);
    const bool is_last = i + 1 == segments.size();
    const auto& end_state = is_last ? orbit.passage.end : segments[i + 1].z;
    const double end = segments[i].start + segments[i].length;
    result.sliding_distance += direction * (relative_displacement(end_state, end) -
                                            relative_displacement(segments[i].z, segments[i].start));
  }
  end_stop(stuck_so_far > 0.0 ? stuck_so_far + stuck_at_start : 0.0);
  // Stuck right up to the section only from the start of a stop that began there.
  if (stuck_so_far == 0.0 && stuck_at_start > shortest_stop) ++result.stops;
  result.stuck_fraction = stuck / length;
  if (orbit.half_period) {
    result.stops *= 2;
    result.reversals *= 2;
    result.sliding_distance *= 2.0;
  }
  return result;
}

inline Regime regime_of(double force, const ContactHistory& history) {
  if (force == 0.0) return Regime::no_friction;
  if (history.stuck_fraction == 1.0) return Regime::stuck;
  if (history.stops == 0) return Regime::non_stop;
  return history.stops <= 2 ? Regime::one_stop : Regime::multi_stop;
}

}  // namespace frahm::periodic
