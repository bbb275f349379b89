#include "solvers/quantities/trace_scan.hpp"

#include <algorithm>
#include <cmath>

namespace frahm::periodic {
namespace {

// Whether a step may have an extreme within that counts in addition to those so far. Bernstein coefficients
// of the cubic Hermite interpolant bound it; the fourth derivative adds less than `slack`.
bool may_matter(const TraceStep& step, const Extremes& so_far) {
  const ValueAndSlope &left = step.left, &right = step.right;
  const double b1 = left.value + left.slope * step.length / 3.0,
               b2 = right.value - right.slope * step.length / 3.0;
  const double slack = 0.02 * step.length * (std::abs(left.slope) + std::abs(right.slope));
  return std::max(b1, b2) + slack > so_far.most || std::min(b1, b2) - slack < so_far.least;
}

// Neither slope against the rise and the secant steep enough (Fritsch and Carlson 1980). A slope that is
// zero, as at every stop, is so to rounding only.
bool is_monotone(const TraceStep& step) {
  const ValueAndSlope &left = step.left, &right = step.right;
  const double rise = right.value - left.value, direction = rise > 0.0 ? 1.0 : -1.0;
  const double steepest = (std::abs(left.slope) + std::abs(right.slope)) * step.length;
  const double least_slope = std::min(direction * left.slope, direction * right.slope) * step.length;
  const double rounding = 1e-13 * std::abs(left.value);
  if (steepest + std::abs(rise) <= rounding) return true;  // held
  return least_slope >= -1e-13 * steepest - rounding && steepest < 2.8 * std::abs(rise);
}

// consider(value, s): a stationary value at fraction s of the step.
template <class Consider>
void consider_interior(const Polynomial& p, double length, const Consider& consider) {
  const Roots stationary = stationary_points(p);
  for (int i = 0; i < stationary.count; ++i) {
    const double s = stationary.at[static_cast<std::size_t>(i)];
    if (s <= length) consider(evaluate(p, s), s);
  }
}

// Held, not arrived at, since its segment began.
bool is_held(double value, double at_segment_start) {
  return std::abs(value - at_segment_start) <= 1e-13 * std::abs(value);
}

// The limits on either side of a change of mode, or of the section, and which of them can be extremes: if the
// trace is continuous there, both or neither; if it jumps, the limit to which it rises and the limit from
// which it falls. sign: of the trace beyond the section of half a period.
void judge_limits(Candidate& end, Candidate& start, double sign, double magnitude) {
  constexpr double kFlat = 1e-10, kContinuous = 1e-12;
  const double flat = kFlat * magnitude;
  const bool continuous = std::abs(end.value - sign * start.value) <= kContinuous * magnitude;
  const bool rises_in = end.slope >= -flat, falls_in = end.slope <= flat;
  const bool falls_out = sign * start.slope <= flat, rises_out = sign * start.slope >= -flat;
  end.can_be_most = rises_in && (falls_out || !continuous);
  end.can_be_least = falls_in && (rises_out || !continuous);
  const bool most = falls_out && (rises_in || !continuous), least = rises_out && (falls_in || !continuous);
  start.can_be_most = sign > 0.0 ? most : least;
  start.can_be_least = sign > 0.0 ? least : most;
}

// The candidates of one trace, with the data that identify an extreme.
class CandidateCollector {
 public:
  explicit CandidateCollector(std::vector<Candidate>& list) : list_(list) { list_.clear(); }

  // Returns its index in the list.
  std::size_t add(const Candidate& candidate) {
    extremes_.most = std::max(extremes_.most, candidate.value);
    extremes_.least = std::min(extremes_.least, candidate.value);
    list_.push_back(candidate);
    return list_.size() - 1;
  }
  const Extremes& extremes() const { return extremes_; }

 private:
  std::vector<Candidate>& list_;
  Extremes extremes_;
};

}  // namespace

Roots stationary_points(const Polynomial& p) {
  const Polynomial slope = derivative(p);
  const double size = slope.cwiseAbs().sum();
  int zeros = 0;
  while (zeros < 3 && std::abs(slope[zeros]) <= 1e-13 * size) ++zeros;
  return sign_changes(deflate(slope, zeros));
}

Extremes scan_extremes(std::span<const TraceStep> trace, double section, double rate,
                       const StepPolynomial& polynomial) {
  ExtremeCollector collector(section, rate);
  double at_segment_start = 0.0;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const TraceStep& step = trace[i];
    if (step.starts_segment) {
      at_segment_start = step.left.value;
      collector.consider(step.left.value, step.start, false);
    }
    if (may_matter(step, collector.extremes()) && !is_monotone(step)) {
      consider_interior(polynomial(i), step.length,
                        [&](double value, double s) { collector.consider(value, step.start + s, true); });
    }
    if (step.ends_segment) {
      const bool reached = !is_held(step.right.value, at_segment_start);
      collector.consider(step.right.value, step.start + step.length, reached);
    }
  }
  return collector.with_phases();
}

Extremes scan_candidates(std::span<const TraceStep> trace, double section_sign,
                         const StepPolynomial& polynomial, std::vector<Candidate>& candidates) {
  CandidateCollector collector(candidates);
  double at_segment_start = 0.0;
  std::ptrdiff_t change = -1;
  std::vector<std::size_t> limits;  // indices in the list of each segment's start and end
  for (std::size_t i = 0; i < trace.size(); ++i) {
    const TraceStep& step = trace[i];
    if (step.starts_segment) {
      at_segment_start = step.left.value;
      limits.push_back(collector.add({.value = step.left.value,
                                      .slope = step.left.slope,
                                      .step = i,
                                      .change = change,
                                      .stationary = false,
                                      .reached = false}));
    }
    if (may_matter(step, collector.extremes()) && !is_monotone(step)) {
      consider_interior(polynomial(i), step.length,
                        [&](double value, double s) { collector.add({.value = value, .step = i, .s = s}); });
    }
    if (step.ends_segment) {
      const bool is_section = i + 1 == trace.size();
      ++change;
      limits.push_back(
          collector.add({.value = step.right.value,
                         .slope = step.right.slope,
                         .step = i,
                         .s = step.length,
                         .change = is_section ? -1 : change,
                         .stationary = false,
                         .reached = !is_held(step.right.value, at_segment_start) && !is_section}));
    }
  }
  const Extremes extremes = collector.extremes();
  for (std::size_t k = 0; k + 1 < limits.size(); k += 2) {
    const bool is_section = k + 2 == limits.size();
    judge_limits(candidates[limits[k + 1]], candidates[limits[is_section ? 0 : k + 2]],
                 is_section ? section_sign : 1.0, extremes.magnitude());
  }
  const double tie = kTiedExtremes * extremes.magnitude();
  std::erase_if(candidates, [&](const Candidate& c) {
    const bool highest = c.can_be_most && c.value >= extremes.most - tie;
    const bool lowest = c.can_be_least && c.value <= extremes.least + tie;
    return !highest && !lowest;
  });
  return extremes;
}

}  // namespace frahm::periodic
