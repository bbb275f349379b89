#pragma once

#include "solvers/transient/record.hpp"

namespace frahm::transient {

// What is known of a record before anything moves; in SI, as its values.
struct RecordFacts {
  double duration = 0.0;                                // [s]
  double shortest = 0.0, longest = 0.0;                 // interval between samples [s]
  double usual = 0.0;                                   // their median [s]
  double longest_from = 0.0;                            // [s] where the longest begins
  bool even = false;                                    // they differ by rounding alone
  double peak = 0.0, peak_time = 0.0;                   // the largest value either way, of a spline its own
  double start = 0.0, end = 0.0;                        // values of the first and the last sample
  double end_velocity = 0.0;                            // [m/s] that a support's acceleration leaves it with
  double end_displacement = 0.0;                        // [m] that its acceleration or velocity does
  double peak_velocity = 0.0, peak_displacement = 0.0;  // the largest at any sample, of those integrated
};

RecordFacts facts_of(const Record& record);

// The least samples in a period of a motion that straight lines between samples still drive well: with 10 the
// driving amplitude is (sin(pi/10)/(pi/10))^2 = 0.967 of the true one.
inline constexpr double kSamplesOfPeriod = 10.0;

// Whether samples are missing: an interval is so much longer than most that it is no sampling.
inline constexpr double kGap = 10.0;
inline bool has_gap(const RecordFacts& facts) {
  return facts.longest > kGap * facts.usual;
}

}  // namespace frahm::transient
