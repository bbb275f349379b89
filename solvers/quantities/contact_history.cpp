#include "solvers/quantities/contact_history.hpp"

#include <cmath>

namespace frahm::periodic {

ContactHistory contact_history(std::span<const ContactStretch> stretches, bool half_period) {
  constexpr double kShortestStop = 1e-9;  // of a period
  ContactHistory result;

  // The direction in which the contact slid before the section; after half a period it is the opposite.
  double direction = 0.0, length = 0.0, stuck = 0.0;
  for (const ContactStretch& stretch : stretches) {
    length += stretch.length;
    if (stretch.sticks)
      stuck += stretch.length;
    else
      direction = (half_period ? -1.0 : 1.0) * stretch.direction;
  }
  if (direction == 0.0) {
    result.stuck_fraction = 1.0;
    return result;
  }
  const double shortest_stop = kShortestStop * (half_period ? 2.0 : 1.0) * length;

  // A stop that spans the section belongs to its arrival, at the end of the list.
  double stuck_at_start = 0.0;
  for (const ContactStretch& stretch : stretches) {
    if (!stretch.sticks) break;
    stuck_at_start += stretch.length;
  }
  double stuck_so_far = 0.0;
  bool slid_before = stuck_at_start == 0.0;
  const auto end_stop = [&](double duration) {
    if (slid_before && duration > shortest_stop) ++result.stops;
  };
  for (const ContactStretch& stretch : stretches) {
    if (stretch.sticks) {
      stuck_so_far += stretch.length;
      continue;
    }
    end_stop(stuck_so_far);
    stuck_so_far = 0.0;
    slid_before = true;
    if (stretch.direction != direction) ++result.reversals;
    direction = stretch.direction;
    result.sliding_distance += std::abs(stretch.slid);  // against its direction, friction still takes energy
  }
  end_stop(stuck_so_far > 0.0 ? stuck_so_far + stuck_at_start : 0.0);
  // Stuck right up to the section only from the start of a stop that began there.
  if (stuck_so_far == 0.0 && stuck_at_start > shortest_stop) ++result.stops;
  result.stuck_fraction = stuck / length;
  if (half_period) {
    result.stops *= 2;
    result.reversals *= 2;
    result.sliding_distance *= 2.0;
  }
  return result;
}

Regime regime_of_stops(int stops) {
  if (stops == 0) return Regime::non_stop;
  return stops <= 2 ? Regime::one_stop : Regime::multi_stop;
}

Regime regime_of(double force, const ContactHistory& history) {
  if (force == 0.0) return Regime::no_friction;
  if (history.stuck_fraction == 1.0) return Regime::stuck;
  return regime_of_stops(history.stops);
}

}  // namespace frahm::periodic
