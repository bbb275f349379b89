#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/algebra/no_value.hpp"
#include "solvers/orbits/phase.hpp"
#include "solvers/quantities/quantity.hpp"

// The largest and least value of a quantity over a period, gathered from candidates.
namespace frahm::periodic {

struct Extremes {
  double most = -kInfinity;
  double least = kInfinity;
  // omega t in [0, 2 pi) at which each is first reached; NaN if it is held throughout.
  double most_phase = kNone;
  double least_phase = kNone;

  double magnitude() const { return std::max(std::abs(most), std::abs(least)); }
  double peak(Side side) const {
    return side == Side::most ? most : side == Side::least ? -least : magnitude();
  }
};

// Keeps the extremes among candidates; of equal ones (to 1e-12) the earliest in omega t.
class ExtremeCollector {
 public:
  ExtremeCollector(double section, double rate) : section_(section), rate_(rate) {}

  // `reached`: the value is arrived at here, not held from before.
  void consider(double value, double at, bool reached) {
    extremes_.most = std::max(extremes_.most, value);
    extremes_.least = std::min(extremes_.least, value);
    if (!reached) return;
    update(most_reached_, extremes_.most_phase, value, at);
    update(least_reached_, extremes_.least_phase, -value, at);
  }
  const Extremes& extremes() const { return extremes_; }

  Extremes with_phases() const {
    Extremes result = extremes_;
    if (most_reached_ < result.most - kEqual * std::abs(result.most)) result.most_phase = kNone;
    if (least_reached_ < -result.least - kEqual * std::abs(result.least)) result.least_phase = kNone;
    return result;
  }

 private:
  static constexpr double kEqual = 1e-12;

  void update(double& reached, double& reached_phase, double value, double at) const {
    const double phase = whole_turns_removed(section_ + at * rate_);
    const double tie = kEqual * std::abs(value);
    if (value < reached - tie || (value <= reached + tie && phase >= reached_phase)) return;
    reached = std::max(reached, value);
    reached_phase = phase;
  }

  double section_, rate_;
  double most_reached_ = -kInfinity;
  double least_reached_ = -kInfinity;
  Extremes extremes_;
};

// The extremes over the whole period of an orbit of which half is known: x(t + T/2) = -x(t).
inline Extremes mirrored(const Extremes& half) {
  constexpr double kEqual = 1e-12;
  Extremes whole;
  whole.most = half.magnitude();
  whole.least = -whole.most;
  const double turned = whole_turns_removed(half.least_phase + std::numbers::pi);
  const double difference = half.most + half.least;  // most - |least|
  const double larger = difference > 0.0 ? half.most_phase : turned;
  // fmin: the one that is reached. What is held from before the section is reached with the opposite sign.
  const bool tied = std::abs(difference) <= kEqual * whole.most || std::isnan(larger);
  whole.most_phase = tied ? std::fmin(half.most_phase, turned) : larger;
  whole.least_phase = whole_turns_removed(whole.most_phase + std::numbers::pi);
  return whole;
}

}  // namespace frahm::periodic
