#pragma once

#include <algorithm>

#include "solvers/algebra/no_value.hpp"

namespace frahm::tuning {

// The progress of the rounds of an exchange, and whether another round will help.
class Convergence {
 public:
  // tolerance: of gap and violation, as promised. closed: the gap below which nothing more can be gained.
  Convergence(double tolerance, double closed) : tolerance_(tolerance), closed_(closed) {}

  // Judges a round; exact: its problem was solved to the last digit, with the maxima followed. Returns true
  // if no more rounds are needed.
  bool judge(double gap, double violation, bool exact) {
    // The solver lets its constraints slip by its own tolerance: the bound may lie above the worst peak by as
    // much. A bound that lies higher is of a problem that was not solved.
    const double size = std::max(gap < -tolerance_ ? -gap : gap, violation);
    const bool falls = size < 0.25 * best_;
    best_ = std::min(best_, size);
    stalled_ = falls ? 0 : stalled_ + 1;
    if (size <= closed_ && exact) return true;
    return size <= tolerance_ ? stalled_ >= 2 : stalled_ >= kPatience;
  }
  bool met() const { return best_ <= tolerance_; }

 private:
  static constexpr int kPatience = 6;
  double tolerance_, closed_;
  double best_ = kInfinity;
  int stalled_ = 0;
};

}  // namespace frahm::tuning
