#pragma once

#include <span>

#include "solvers/quantities/quantity.hpp"

namespace frahm::periodic {

// What a friction contact does in a period.
struct ContactHistory {
  int stops = 0;                  // stuck intervals of finite length
  int reversals = 0;              // changes of sliding direction, with or without a stop
  double stuck_fraction = 0.0;    // of the period
  double sliding_distance = 0.0;  // [m]
};

// A contact over a stretch of the response in one mode.
struct ContactStretch {
  double length = 0.0;  // of time, in any unit
  bool sticks = false;
  double direction = 1.0;  // +1 or -1, of a sliding contact
  double slid = 0.0;       // by which its relative displacement grows [m]
};

// stretches: over a period, or over half a period after which all repeats with the opposite sign.
ContactHistory contact_history(std::span<const ContactStretch> stretches, bool half_period);

// For a contact that slides and comes to rest so often in a period.
Regime regime_of_stops(int stops);

// For a contact whose friction is `force` [N].
Regime regime_of(double force, const ContactHistory& history);

}  // namespace frahm::periodic
