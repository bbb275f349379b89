#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "solvers/periodic/linear_form.hpp"
#include "solvers/periodic/orbit_steps.hpp"

// The largest and least value of a quantity over an orbit: stationary points solved, never the largest
// sample, and both one-sided limits wherever the mode changes.
namespace frahm::periodic {

struct Extremes {
  double most = -std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  // omega t in [0, 2 pi) at which each is first reached; NaN where it is only held.
  double most_phase = std::numeric_limits<double>::quiet_NaN();
  double least_phase = std::numeric_limits<double>::quiet_NaN();

  double magnitude() const { return std::max(std::abs(most), std::abs(least)); }
};

// The angle in [0, 2 pi); an angle within 1e-9 of 2 pi is 0.
inline double whole_turns_removed(double phase) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double angle = phase - kTurn * std::floor(phase / kTurn);
  return angle > kTurn - 1e-9 ? 0.0 : angle;
}

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
    constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
    Extremes result = extremes_;
    if (most_reached_ < result.most - kEqual * std::abs(result.most)) result.most_phase = kNever;
    if (least_reached_ < -result.least - kEqual * std::abs(result.least)) result.least_phase = kNever;
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
  double most_reached_ = -std::numeric_limits<double>::infinity();
  double least_reached_ = -std::numeric_limits<double>::infinity();
  Extremes extremes_;
};

// Interior stationary values of a form over one step, where they could matter.
template <int N, int H>
void consider_interior(const OrbitSteps<N, H>& orbit, OrbitStep<N, H>& step, const LinearForm<N, H>& form,
                       ValueAndSlope left, ValueAndSlope right, ExtremeCollector& collector) {
  // Bernstein coefficients of the cubic Hermite interpolant bound it; the fourth derivative adds less than
  // `slack`.
  const double b1 = left.value + left.slope * step.length / 3.0,
               b2 = right.value - right.slope * step.length / 3.0;
  const double slack = 0.02 * step.length * (std::abs(left.slope) + std::abs(right.slope));
  const Extremes& so_far = collector.extremes();
  if (std::max(b1, b2) + slack <= so_far.most && std::min(b1, b2) - slack >= so_far.least) return;
  // Neither slope against the rise and the secant steep enough: monotone (Fritsch and Carlson 1980). A slope
  // that is zero, as at every stop, is so to rounding only.
  const double rise = right.value - left.value, direction = rise > 0.0 ? 1.0 : -1.0;
  const double steepest = (std::abs(left.slope) + std::abs(right.slope)) * step.length;
  const double least_slope = std::min(direction * left.slope, direction * right.slope) * step.length;
  const double rounding = 1e-13 * std::abs(left.value);
  if (steepest + std::abs(rise) <= rounding) return;  // held
  if (least_slope >= -1e-13 * steepest - rounding && steepest < 2.8 * std::abs(rise)) return;
  const Polynomial p = form.polynomial(orbit.expand(step));
  // After a stop or a release the slope starts from zero like s or s^2: that root is the step's end, divide
  // it out.
  Polynomial slope = derivative(p);
  const double size = slope.cwiseAbs().sum();
  int zeros = 0;
  while (zeros < 3 && std::abs(slope[zeros]) <= 1e-13 * size) ++zeros;
  const Roots stationary = sign_changes(deflate(slope, zeros));
  for (int i = 0; i < stationary.count; ++i) {
    const double s = stationary.at[static_cast<std::size_t>(i)];
    if (s <= step.length) collector.consider(evaluate(p, s), step.start + s, true);
  }
}

// `form_of(mode)` gives the quantity's form in a mode.
template <int N, int H, class FormOf>
Extremes find_extremes(OrbitSteps<N, H>& orbit, const Flow<N, H>& flow, double section,
                       const FormOf& form_of) {
  ExtremeCollector collector(section, flow.fundamental_rate());
  LinearForm<N, H> form;
  bool starts_segment = true;
  double at_segment_start = 0.0;
  for (OrbitStep<N, H>& step : orbit.steps()) {
    if (starts_segment) form = form_of(flow.mode(step.mode));
    const ValueAndSlope left = form.at(step.left), right = form.at(step.right);
    if (starts_segment) {
      at_segment_start = left.value;
      collector.consider(left.value, step.start, false);
    }
    consider_interior(orbit, step, form, left, right, collector);
    if (step.ends_segment) {
      const bool held = std::abs(right.value - at_segment_start) <= 1e-13 * std::abs(right.value);
      const bool is_section = &step == &orbit.steps().back();
      collector.consider(right.value, step.start + step.length, !held && !is_section);
    }
    starts_segment = step.ends_segment;
  }
  return collector.with_phases();
}

// The extremes over the whole period of an orbit of which half is known: x(t + T/2) = -x(t).
inline Extremes mirrored(const Extremes& half) {
  constexpr double kEqual = 1e-12;
  Extremes whole;
  whole.most = half.magnitude();
  whole.least = -whole.most;
  const double turned = whole_turns_removed(half.least_phase + std::numbers::pi);
  const double difference = half.most + half.least;  // most - |least|
  if (std::abs(difference) <= kEqual * whole.most)
    whole.most_phase = std::fmin(half.most_phase, turned);  // fmin: the one that is reached
  else
    whole.most_phase = difference > 0.0 ? half.most_phase : turned;
  whole.least_phase = whole_turns_removed(whole.most_phase + std::numbers::pi);
  return whole;
}

}  // namespace frahm::periodic
