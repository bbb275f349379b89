#pragma once

#include <algorithm>
#include <cmath>

#include "solvers/quantities/extreme_values.hpp"
#include "solvers/flow/linear_form.hpp"
#include "solvers/quantities/orbit_steps.hpp"

// The largest and least value of a quantity over an orbit: stationary points solved, never the largest
// sample, and both one-sided limits wherever the mode changes.
namespace frahm::periodic {

// Interior stationary values of a form over one step, where they could matter.
template <int N, int H, class Collector>
void consider_interior(const OrbitSteps<N, H>& orbit, OrbitStep<N, H>& step, const LinearForm<N, H>& form,
                       ValueAndSlope left, ValueAndSlope right, Collector& collector) {
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

}  // namespace frahm::periodic
