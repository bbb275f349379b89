#pragma once

#include "solvers/algebra/no_value.hpp"

namespace frahm::periodic {

// Of the search for the orbits of one point [s]: `check`, and a run that is told to stop, wait for it.
inline constexpr double kMostWork = 10.0;
inline constexpr const char* kSearchIsLong =
    "the search was ended after some ten seconds of work: its motions have so many steps and events";

// The work of the motions that a search follows, reckoned from their steps and events, so that a search which
// is too long ends after the same passage on every machine. In seconds of a core of 2026, within a factor of
// three.
class SearchWork {
 public:
  // Of one search [s]; without a call it is not limited.
  void set_limit(double seconds) { most_ = seconds; }
  void begin() { done_ = 0.0; }  // another search
  void add(double seconds) { done_ += seconds; }
  bool is_over() const { return done_ > most_; }

 private:
  double done_ = 0.0, most_ = kInfinity;
};

}  // namespace frahm::periodic
