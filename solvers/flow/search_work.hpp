#pragma once

#include "solvers/algebra/no_value.hpp"

namespace frahm::periodic {

// For the search for the orbits of one point [s]: `check`, and a run that is asked to stop, wait for it.
inline constexpr double kMostWork = 10.0;
inline constexpr const char* kSearchIsLong =
    "the search was ended after about ten seconds of work, because its motions have so many steps and events";

// The work of the motions that a search follows, computed from their steps and events, so that a search which
// is too long ends after the same passage on every machine. In seconds of a core of 2026, within a factor of
// three.
class SearchWork {
 public:
  void add(double seconds) { done_ += seconds; }
  bool is_over() const { return done_ > most_; }
  void begin() { done_ = 0.0; }  // another search

 private:
  friend class LimitedSearch;
  double done_ = 0.0, most_ = kInfinity;
};

// While it lives, what is followed belongs to one search of limited work.
class LimitedSearch {
 public:
  explicit LimitedSearch(SearchWork& work, double most_seconds = kMostWork) : work_(work) {
    work_.begin();
    work_.most_ = most_seconds;
  }
  ~LimitedSearch() { work_.most_ = kInfinity; }
  LimitedSearch(const LimitedSearch&) = delete;
  LimitedSearch& operator=(const LimitedSearch&) = delete;

 private:
  SearchWork& work_;
};

}  // namespace frahm::periodic
