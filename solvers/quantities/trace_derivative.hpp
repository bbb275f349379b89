#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/quantities/extremes.hpp"
#include "solvers/quantities/orbit_sensitivity.hpp"
#include "solvers/quantities/trace.hpp"

// Derivatives of what is traced along an orbit, and of its extremes.
namespace frahm::periodic {

// A value that may be a trace's extreme: a stationary one, or a one-sided limit where the mode changes.
template <int N, int H>
struct Candidate {
  double value = 0.0;
  double slope = 0.0;  // a step; of a stationary value 0
  std::size_t step = 0;
  double s = 0.0;              // steps since that step's start
  std::ptrdiff_t change = -1;  // of mode, whose limit it is; -1: none
  bool stationary = true;      // within a segment
  bool reached = true;         // arrived at here, not held from before
  bool can_be_most = true;     // a local maximum of the trace; so is every stationary value that counts
  bool can_be_least = true;    // a local minimum
  Instant<N, H> at{};
};

// The candidates of one trace, with what an extreme needs to be told from others.
template <int N, int H>
class CandidateCollector {
 public:
  explicit CandidateCollector(std::vector<Candidate<N, H>>& list) : list_(list) { list_.clear(); }

  void begin_step(std::size_t step, double start) {
    step_ = step;
    start_ = start;
  }
  void consider(double value, double at, bool) { add({.value = value, .step = step_, .s = at - start_}); }
  void add(Candidate<N, H> candidate) {
    extremes_.most = std::max(extremes_.most, candidate.value);
    extremes_.least = std::min(extremes_.least, candidate.value);
    list_.push_back(std::move(candidate));
  }
  const Extremes& extremes() const { return extremes_; }

 private:
  std::vector<Candidate<N, H>>& list_;
  Extremes extremes_;
  std::size_t step_ = 0;
  double start_ = 0.0;
};

// The limits on either side of a change of mode, or of the section, which of them can be extremes: where the
// trace is continuous there, both or neither; where it jumps, that which it rises to, and that which it falls
// from. sign: of the trace beyond the section of half a period.
template <int N, int H>
void judge_limits(Candidate<N, H>& end, Candidate<N, H>& start, double sign, double magnitude) {
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

// Candidates within this part of the largest magnitude are the same extreme, or tie for it.
inline constexpr double kTiedExtremes = 1e-10;

// The candidates for the largest and for the least value; returns these. `form_of(mode)` is the trace's form.
template <int N, int H, class FormOf>
Extremes find_candidates(OrbitSteps<N, H>& orbit, const Flow<N, H>& flow, double section, double section_sign,
                         const FormOf& form_of, std::vector<Candidate<N, H>>& list) {
  CandidateCollector<N, H> collector(list);
  LinearForm<N, H> form;
  bool starts_segment = true;
  double at_segment_start = 0.0;
  std::ptrdiff_t change = -1;
  std::vector<std::size_t> limits;  // places in the list of each segment's start and end
  const auto steps = orbit.steps();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    OrbitStep<N, H>& step = steps[i];
    if (starts_segment) form = form_of(flow.mode(step.mode));
    const ValueAndSlope left = form.at(step.left), right = form.at(step.right);
    if (starts_segment) {
      at_segment_start = left.value;
      collector.add({left.value, left.slope, i, 0.0, change, false, false, true, true, step.left});
      limits.push_back(list.size() - 1);
    }
    collector.begin_step(i, step.start);
    consider_interior(orbit, step, form, left, right, collector);
    if (step.ends_segment) {
      const bool is_section = i + 1 == steps.size();
      const bool held = std::abs(right.value - at_segment_start) <= 1e-13 * std::abs(right.value);
      ++change;
      collector.add({right.value, right.slope, i, step.length, is_section ? -1 : change, false,
                     !held && !is_section, true, true, step.right});
      limits.push_back(list.size() - 1);
    }
    starts_segment = step.ends_segment;
  }
  const Extremes extremes = collector.extremes();
  const double tie = kTiedExtremes * extremes.magnitude();
  for (std::size_t k = 0; k + 1 < limits.size(); k += 2) {
    const bool is_section = k + 2 == limits.size();
    judge_limits(list[limits[k + 1]], list[limits[is_section ? 0 : k + 2]], is_section ? section_sign : 1.0,
                 extremes.magnitude());
  }
  const auto is_below = [&](const Candidate<N, H>& c) {
    const bool highest = c.can_be_most && c.value >= extremes.most - tie;
    const bool lowest = c.can_be_least && c.value <= extremes.least + tie;
    return !highest && !lowest;
  };
  list.erase(std::remove_if(list.begin(), list.end(), is_below), list.end());
  for (Candidate<N, H>& c : list) {
    if (!c.stationary) continue;
    typename Sizes<N, H>::State z;
    Flow<N, H>::evaluate(steps[c.step].expansion, c.s, z);
    const double phase = section + (steps[c.step].start + c.s) * flow.fundamental_rate();
    flow.instant_at(z, phase, flow.mode(steps[c.step].mode), c.at);
  }
  return extremes;
}

// The derivative of a trace at one instant, time held. `laws_by`: the derivative of `laws`.
template <int N, int H>
class TraceDerivative {
 public:
  using Laws = std::vector<mechanics::ElementCoefficients>;

  TraceDerivative(const mechanics::Assembly& assembly, const Flow<N, H>& flow,
                  const PassageSensitivity<N, H>& sensitivity, const Laws& coefficients, const Laws& laws_by)
      : assembly_(assembly), flow_(flow), sensitivity_(sensitivity), laws_(coefficients), laws_by_(laws_by) {}

  // d: of the instant x, which lies in `mode`.
  double of(const Trace& trace, const Instant<N, H>& x, const InstantDerivative<N, H>& d,
            std::size_t mode) const {
    switch (trace.measure) {
      case Measure::velocity_peak:
        return velocity(trace.at, x, d).by;
      case Measure::acceleration_peak:
        return acceleration(trace.at, x, d).by;
      case Measure::force_peak:
        return element_force(trace.element, x, d, mode);
      case Measure::transmitted_force:
        return node_force(trace.node, x, d, mode);
      default:
        return displacement(trace.at, x, d).by;
    }
  }

 private:
  struct ValueAndDerivative {
    double value, by;
  };

  // w^T q + p^T y and its derivative, of displacements, velocities or accelerations [m a step^k].
  template <class Q, class QBy, class Motion, class MotionBy>
  ValueAndDerivative relative(const mechanics::Incidence& at, const Q& q, const QBy& q_by, const Motion& y,
                              const MotionBy& y_by, const Instant<N, H>& x) const {
    ValueAndDerivative u{at.w.dot(q), at.w.dot(q_by)};
    if (at.p.size() > 0) {
      u.value += at.p.dot(y * x.u);
      u.by += at.p.dot(y_by * x.u);
    }
    return u;
  }
  ValueAndDerivative displacement(const mechanics::Incidence& at, const Instant<N, H>& x,
                                  const InstantDerivative<N, H>& d) const {
    const Eigen::Index n = x.a.size();
    return relative(at, x.z.head(n), d.z.head(n), flow_.equations().motion, by().motion, x);
  }
  // v/h:  d(v/h) = dv/h - (v/h) dh/h
  ValueAndDerivative velocity(const mechanics::Incidence& at, const Instant<N, H>& x,
                              const InstantDerivative<N, H>& d) const {
    const Eigen::Index n = x.a.size();
    const double h = flow_.equations().step;
    const auto [v, v_by] = relative(at, x.z.segment(n, n), d.z.segment(n, n),
                                    flow_.equations().motion_velocity, by().motion_velocity, x);
    return {v / h, (v_by - v * by().log_step) / h};
  }
  // a/h^2
  ValueAndDerivative acceleration(const mechanics::Incidence& at, const Instant<N, H>& x,
                                  const InstantDerivative<N, H>& d) const {
    const double h2 = flow_.equations().step * flow_.equations().step;
    const auto [a, a_by] =
        relative(at, x.a, d.a, flow_.equations().motion_acceleration, by().motion_acceleration, x);
    return {a / h2, (a_by - 2.0 * a * by().log_step) / h2};
  }

  // F = k u + c v + b v' + s + its share of the friction, each product by the product rule.
  double element_force(std::size_t e, const Instant<N, H>& x, const InstantDerivative<N, H>& d,
                       std::size_t mode) const {
    const mechanics::Incidence& at = assembly_.incidences()[e];
    const mechanics::ElementCoefficients &law = laws_[e], &law_by = laws_by_[e];
    double force = 0.0;
    const auto add = [&](double factor, double factor_by, const ValueAndDerivative& motion) {
      force += factor_by * motion.value + factor * motion.by;
    };
    if (law.stiffness != 0.0 || law_by.stiffness != 0.0)
      add(law.stiffness, law_by.stiffness, displacement(at, x, d));
    if (law.damping != 0.0 || law_by.damping != 0.0) add(law.damping, law_by.damping, velocity(at, x, d));
    if (law.inertance != 0.0 || law_by.inertance != 0.0)
      add(law.inertance, law_by.inertance, acceleration(at, x, d));
    if (law.internal >= 0) force += d.z[2 * at.w.size() + law.internal];
    if (law.friction != 0.0 || law_by.friction != 0.0) force += friction(e, x, d, mode);
    return force;
  }

  // sigma F of a sliding contact; of a stuck one the share F / sum F of its force lambda.
  double friction(std::size_t e, const Instant<N, H>& x, const InstantDerivative<N, H>& d,
                  std::size_t mode_index) const {
    const Mode<N, H>& mode = flow_.mode(mode_index);
    const mechanics::ContactShare& place = assembly_.shares()[e];
    const auto j = static_cast<Eigen::Index>(place.contact);
    if (!contains(mode.stuck, j)) return place.orientation * mode.sign(j) * laws_by_[e].friction;
    const double limit = flow_.equations().limit[j];
    const double share = laws_[e].friction / limit;
    const double share_by = (laws_by_[e].friction - share * by().limit[j]) / limit;
    const double lambda_by = sensitivity_.stuck_force(mode_index, x, d.z, j);
    return place.orientation * (share * lambda_by + share_by * flow_.stuck_force(x, mode, j).value);
  }

  double node_force(const mechanics::Node& node, const Instant<N, H>& x, const InstantDerivative<N, H>& d,
                    std::size_t mode) const {
    double sum = 0.0;
    const auto& elements = assembly_.network().elements;
    for (std::size_t e = 0; e < elements.size(); ++e) {
      if (elements[e].b == node) sum += element_force(e, x, d, mode);
      if (elements[e].a == node) sum -= element_force(e, x, d, mode);
    }
    return sum;
  }

  const StepDerivative<N, H>& by() const { return sensitivity_.equations(); }

  const mechanics::Assembly& assembly_;
  const Flow<N, H>& flow_;
  const PassageSensitivity<N, H>& sensitivity_;
  const Laws &laws_, &laws_by_;
};

}  // namespace frahm::periodic
