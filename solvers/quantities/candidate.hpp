#pragma once

#include <cstddef>

#include "solvers/quantities/extreme_values.hpp"

namespace frahm::periodic {

// A value that may be a trace's extreme: a stationary one, or a one-sided limit where the mode changes.
struct Candidate {
  double value = 0.0;
  double slope = 0.0;  // a step; of a stationary value 0
  std::size_t step = 0;
  double s = 0.0;              // steps since the start of that step
  std::ptrdiff_t change = -1;  // the change of mode whose limit it is; -1: none
  bool stationary = true;      // within a segment
  bool reached = true;         // reached here, not held from before
  bool can_be_most = true;     // a local maximum of the trace; so is every stationary value that counts
  bool can_be_least = true;    // a local minimum
};

// Candidates within this part of the largest magnitude are the same extreme, or tie for it.
inline constexpr double kTiedExtremes = 1e-10;

// Whether the candidate is, or ties for, the trace's largest value on this side; and the least.
// found: the extremes of all candidates.
inline bool is_most(const Candidate& candidate, const Extremes& found, Side side) {
  const double tie = kTiedExtremes * found.magnitude();
  const double most = side == Side::either ? found.magnitude() : found.most;
  return side != Side::least && candidate.can_be_most && candidate.value >= most - tie;
}
inline bool is_least(const Candidate& candidate, const Extremes& found, Side side) {
  const double tie = kTiedExtremes * found.magnitude();
  const double least = side == Side::either ? -found.magnitude() : found.least;
  return side != Side::most && candidate.can_be_least && candidate.value <= least + tie;
}

}  // namespace frahm::periodic
