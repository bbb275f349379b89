#pragma once

#include <Eigen/LU>
#include <span>
#include <vector>

#include "solvers/periodic/orbit_steps.hpp"
#include "solvers/periodic/step_derivative.hpp"

// The derivative of a periodic orbit through its events, at fixed time in steps (step_derivative.hpp):
//   delta(t) = d z(t) / d p,   delta' = A delta + dA z + dB u + ...   between events,
// a jump where a contact comes to rest or reverses, and (1 - s Phi) delta(0) = s g_p over the orbit, Phi the
// passage's tangent, s = -1 where it is of half a period.
// Sources: Leine and Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004, ch. 7;
// Hiskens and Pai, Trajectory sensitivity analysis of hybrid systems, IEEE Trans. Circuits Syst. I 47 (2000).
namespace frahm::periodic {

// State, acceleration and their derivative at one instant, seen from inside a mode.
template <int N, int H>
struct InstantDerivative {
  typename Sizes<N, H>::State z;
  typename Sizes<N, H>::Vector a;
};

// The change of mode between a segment and the next.
struct ModeChange {
  std::size_t step = 0;        // the last one before it
  Eigen::Index arrived = -1;   // a contact that comes to rest or reverses; -1: none
  Eigen::Index released = -1;  // one that lets go while none arrives
  double slope = 0.0;          // of what reaches its end there: relative velocity, or stuck force, a step
  double side = 1.0;           // of a release: sign of the force
};

template <int N, int H>
class OrbitSensitivity {
 public:
  using S = Sizes<N, H>;

  explicit OrbitSensitivity(const Flow<N, H>& flow) : flow_(flow) {}

  // Makes ready for derivatives of this orbit, laid out in `steps`; both must outlive them.
  // Returns "" or why the orbit has none.
  const char* prepare(const Orbit<N, H>& orbit, OrbitSteps<N, H>& steps);

  // Along one direction; `by` must outlive what is asked below. Returns "" or why there is none.
  const char* differentiate(const StepDerivative<N, H>& by);

  // Taylor polynomials of delta over a step, a column for each component of the state.
  const typename S::StatePolynomials& polynomials(std::size_t step) const { return polynomials_[step]; }
  // At fraction `s` of a step, where the state is `at`.
  InstantDerivative<N, H> at(std::size_t step, double s, const Instant<N, H>& at) const;
  // Of lambda_j [N] of a contact that sticks in the mode, at instant x whose state changes by `delta`.
  double stuck_force(std::size_t mode, const Instant<N, H>& x, const typename S::State& delta,
                     Eigen::Index contact) const;
  const StepDerivative<N, H>& equations() const { return *by_; }

  // One less than there are segments.
  const std::vector<ModeChange>& changes() const { return changes_; }
  // Derivative of the instant of a change [steps].
  double shift(std::size_t change) const { return shifts_[change]; }

 private:
  const char* find_changes();
  void set_modes();
  typename S::State sweep(const typename S::State& start);
  void expand(const OrbitStep<N, H>& step, const typename S::State& start,
              typename S::StatePolynomials& p) const;
  void enter(typename S::State& delta) const;
  void cross(std::size_t change, typename S::State& delta);
  void add_rest_positions(typename S::State& right_side) const;

  const Flow<N, H>& flow_;
  const Orbit<N, H>* orbit_ = nullptr;
  std::span<OrbitStep<N, H>> steps_;
  const StepDerivative<N, H>* by_ = nullptr;
  std::vector<ModeDerivative<N, H>> modes_;  // in the order of the flow's; of those the orbit is in
  std::vector<ModeChange> changes_;
  std::vector<double> shifts_;
  std::vector<typename S::StatePolynomials> polynomials_;
  Eigen::PartialPivLU<typename S::StateSquare> periodicity_;  // of 1 - s Phi
};

template <int N, int H>
const char* OrbitSensitivity<N, H>::prepare(const Orbit<N, H>& orbit, OrbitSteps<N, H>& steps) {
  const StepEquations<N, H>& eq = flow_.equations();
  orbit_ = &orbit;
  steps.lay_out(orbit);
  for (OrbitStep<N, H>& step : steps.steps()) steps.expand(step);
  steps_ = steps.steps();
  polynomials_.resize(std::max(polynomials_.size(), steps_.size()));
  if (orbit.passage.starts_at_event)
    return "events follow one another too closely for a section between them";
  if (const char* reason = find_changes(); *reason != '\0') return reason;
  shifts_.assign(changes_.size(), 0.0);

  typename S::StateSquare A = -orbit.sign() * orbit.passage.tangent;
  A.diagonal().array() += 1.0;
  if (!orbit.half_period && orbit.stuck_throughout != 0) {
    // A rest position may be anywhere: w^T dq(0), which is known, stands in its place.
    for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
      if (!contains(orbit.stuck_throughout, j)) continue;
      A.topLeftCorner(eq.masses(), eq.masses()) += eq.W.col(j) * eq.W.col(j).transpose();
    }
  }
  periodicity_.compute(A);
  return "";
}

template <int N, int H>
const char* OrbitSensitivity<N, H>::find_changes() {
  const StepEquations<N, H>& eq = flow_.equations();
  changes_.clear();
  for (std::size_t i = 0; i + 1 < steps_.size(); ++i) {
    if (!steps_[i].ends_segment) continue;
    const Mode<N, H>&before = flow_.mode(steps_[i].mode), &after = flow_.mode(steps_[i + 1].mode);
    ModeChange change{.step = i};
    for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
      const bool stuck_before = contains(before.stuck, j), stuck_after = contains(after.stuck, j);
      if (stuck_before && !stuck_after && change.released < 0) change.released = j;
      if (stuck_before || (!stuck_after && before.sign(j) == after.sign(j))) continue;
      if (eq.limit[j] == 0.0) continue;  // its friction, which is none, does not change
      if (change.arrived >= 0) return "several contacts come to rest at one instant";
      change.arrived = j;
    }
    if (change.arrived >= 0) {
      change.slope = flow_.sliding_speed(steps_[i].right, change.arrived).slope;
    } else if (change.released >= 0) {
      const ValueAndSlope force = flow_.stuck_force(steps_[i].right, before, change.released);
      change.slope = force.slope;
      change.side = force.value > 0.0 ? 1.0 : -1.0;
    }
    changes_.push_back(change);
  }
  return "";
}

template <int N, int H>
const char* OrbitSensitivity<N, H>::differentiate(const StepDerivative<N, H>& by) {
  by_ = &by;
  set_modes();
  const typename S::State g_p = sweep(S::State::Zero(flow_.equations().states()));
  typename S::State right_side = orbit_->sign() * g_p;
  add_rest_positions(right_side);
  const typename S::State start = periodicity_.solve(right_side);
  constexpr double kBeyondRounding = 1e12;
  const StepEquations<N, H>& eq = flow_.equations();
  if (!start.allFinite() || eq.energy_norm(start) > kBeyondRounding * eq.energy_norm(right_side)) {
    return "the period map has a multiplier of 1: the response is one of many";
  }
  sweep(start);
  return "";
}

template <int N, int H>
void OrbitSensitivity<N, H>::set_modes() {
  std::vector<bool> done;
  for (const Segment<N, H>& segment : orbit_->passage.segments) {
    if (segment.mode >= done.size()) done.resize(segment.mode + 1, false);
    if (segment.mode >= modes_.size()) modes_.resize(segment.mode + 1);
    if (!done[segment.mode]) modes_[segment.mode].set(flow_, flow_.mode(segment.mode), *by_);
    done[segment.mode] = true;
  }
}

// delta over the passage from a given derivative of the state at the section; returns that at the end.
template <int N, int H>
typename Sizes<N, H>::State OrbitSensitivity<N, H>::sweep(const typename S::State& start) {
  typename S::State delta = start;
  enter(delta);
  std::size_t change = 0;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const OrbitStep<N, H>& step = steps_[i];
    expand(step, delta, polynomials_[i]);
    delta.noalias() = polynomials_[i].transpose() * powers(step.length);
    if (step.ends_segment && i + 1 < steps_.size()) cross(change++, delta);
  }
  return delta;
}

// The Taylor series of delta over a step: coefficient k + 1 is the derivative of coefficient k over k + 1.
template <int N, int H>
void OrbitSensitivity<N, H>::expand(const OrbitStep<N, H>& step, const typename S::State& start,
                                    typename S::StatePolynomials& p) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const Configuration<N, H>& c = flow_.configuration(flow_.mode(step.mode));
  const ModeDerivative<N, H>& d = modes_[step.mode];
  const Expansion<N, H>& x = step.expansion;
  const Eigen::Index n = eq.masses(), maxwell = eq.maxwell_elements();
  Eigen::Matrix<double, kTerms, N> drive(kTerms, n);
  drive.noalias() = x.z * d.acceleration_z.transpose();
  drive.noalias() += x.u * d.acceleration_u.transpose();
  Eigen::Matrix<double, kTerms, S::kMaxwell> maxwell_drive(kTerms, maxwell);
  if constexpr (S::kMaxwell != 0) {
    maxwell_drive.noalias() = x.z * by_->maxwell_by_state.transpose();
    maxwell_drive.noalias() += x.u * by_->maxwell_drive.transpose();
  }
  p.resize(kTerms, eq.states());
  typename S::Vector q = start.head(n), v = start.segment(n, n), a(n);
  typename S::Maxwell s = start.tail(maxwell), ds(maxwell);
  for (int k = 0; k < kTerms; ++k) {
    p.row(k).head(n) = q.transpose();
    p.row(k).segment(n, n) = v.transpose();
    a.noalias() = c.Aq * q;
    a.noalias() += c.Av * v;
    a += drive.row(k).transpose();
    const double share = 1.0 / (k + 1.0);
    if constexpr (S::kMaxwell != 0) {
      p.row(k).tail(maxwell) = s.transpose();
      a += c.As * s;
      ds = eq.maxwell_stiffness.asDiagonal() * (eq.D.transpose() * v) - eq.maxwell_rate.asDiagonal() * s;
      s = (ds + maxwell_drive.row(k).transpose()) * share;
    }
    q = v * share;
    v = a * share;
  }
}

// Contacts that stick at the section: w_j^T v + p_j^T y' = 0 holds before and after.
template <int N, int H>
void OrbitSensitivity<N, H>::enter(typename S::State& delta) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const Mode<N, H>& mode = flow_.mode(steps_.front().mode);
  if (mode.stuck == 0) return;
  const Eigen::Index n = eq.masses();
  const typename S::Contacts slip =
      eq.W.transpose() * delta.segment(n, n) + by_->support_velocity * steps_.front().left.u;
  delta.segment(n, n) -= flow_.configuration(mode).reaction() * slip;
}

// What reaches its end at the change, g(z, p) = 0, does so later by dt = -dg / g'. Then
//   dv+ = dv- + (a- - a+) dt,
// and dv+ = dv- where a release alone leaves the acceleration as it is.
template <int N, int H>
void OrbitSensitivity<N, H>::cross(std::size_t i, typename S::State& delta) {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  const ModeChange& change = changes_[i];
  const OrbitStep<N, H>&before = steps_[change.step], &after = steps_[change.step + 1];
  auto dv = delta.segment(n, n);
  if (change.arrived >= 0) {
    const Eigen::Index j = change.arrived;
    const double velocity = eq.W.col(j).dot(dv) + by_->support_velocity.row(j).dot(before.right.u);
    shifts_[i] = -velocity / change.slope;
    dv += (before.right.a - after.left.a) * shifts_[i];
  } else if (change.released >= 0) {
    const Eigen::Index j = change.released;
    const double force = stuck_force(before.mode, before.right, delta, j);
    shifts_[i] = (change.side * by_->limit[j] - force) / change.slope;
  }
}

template <int N, int H>
double OrbitSensitivity<N, H>::stuck_force(std::size_t mode, const Instant<N, H>& x,
                                           const typename S::State& delta, Eigen::Index j) const {
  const Eigen::Index n = flow_.equations().masses();
  const Configuration<N, H>& c = flow_.configuration(flow_.mode(mode));
  const ModeDerivative<N, H>& d = modes_[mode];
  double force = c.Lq.row(j).dot(delta.head(n)) + c.Lv.row(j).dot(delta.segment(n, n));
  if constexpr (S::kMaxwell != 0) force += c.Ls.row(j).dot(delta.tail(flow_.equations().maxwell_elements()));
  return force + d.force_z.row(j).dot(x.z) + d.force_u.row(j).dot(x.u);
}

// A contact that sticks throughout rests where the energy is least, which makes the mean of w^T q zero:
//   w^T q(t) = -p^T (y(t) - mean y).
template <int N, int H>
void OrbitSensitivity<N, H>::add_rest_positions(typename S::State& right_side) const {
  if (orbit_->half_period || orbit_->stuck_throughout == 0) return;
  const StepEquations<N, H>& eq = flow_.equations();
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (!contains(orbit_->stuck_throughout, j)) continue;
    typename S::OscillatorRow moving = by_->support_displacement.row(j);
    moving[0] = 0.0;  // its mean
    right_side.head(eq.masses()) -= eq.W.col(j) * moving.dot(steps_.front().left.u);
  }
}

template <int N, int H>
InstantDerivative<N, H> OrbitSensitivity<N, H>::at(std::size_t i, double s, const Instant<N, H>& at) const {
  const Eigen::Index n = flow_.equations().masses();
  const OrbitStep<N, H>& step = steps_[i];
  const Configuration<N, H>& c = flow_.configuration(flow_.mode(step.mode));
  const ModeDerivative<N, H>& d = modes_[step.mode];
  InstantDerivative<N, H> result;
  result.z = polynomials_[i].transpose() * powers(s);
  result.a = c.Aq * result.z.head(n) + c.Av * result.z.segment(n, n);
  if constexpr (S::kMaxwell != 0) result.a += c.As * result.z.tail(flow_.equations().maxwell_elements());
  result.a += d.acceleration_z * at.z + d.acceleration_u * at.u;
  return result;
}

}  // namespace frahm::periodic
