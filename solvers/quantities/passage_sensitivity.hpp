#pragma once

#include <span>
#include <vector>

#include "solvers/quantities/orbit_steps.hpp"
#include "solvers/quantities/step_derivative.hpp"

// The derivative of a motion over a passage, through its events, at fixed time in steps
// (step_derivative.hpp):
//   delta(t) = d z(t) / d p,   delta' = A delta + dA z + dB u + ...   between events,
// a jump where a contact comes to rest or reverses.
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
  ContactMask arrived = 0;     // contacts that come to rest or reverse
  Eigen::Index released = -1;  // one that lets go while none arrives; -1: none
  double slope = 0.0;          // of what reaches its end there: relative velocity, or stuck force, a step
  double side = 1.0;           // of a release: sign of the force

  bool is_several() const { return (arrived & (arrived - 1)) != 0; }
  Eigen::Index arriving() const { return __builtin_ctzll(arrived); }  // of a single one
};

inline constexpr const char* kSeveralArrive = "several contacts come to rest at one instant";

// From the mode `before` to `after`, at the instant x seen from inside the first.
template <int N, int H>
ModeChange mode_change(const Flow<N, H>& flow, const Mode<N, H>& before, const Instant<N, H>& x,
                       const Mode<N, H>& after) {
  const StepEquations<N, H>& eq = flow.equations();
  ModeChange change;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    const bool stuck_before = contains(before.stuck, j), stuck_after = contains(after.stuck, j);
    if (stuck_before && !stuck_after && change.released < 0) change.released = j;
    if (stuck_before || (!stuck_after && before.sign(j) == after.sign(j))) continue;
    if (eq.limit[j] == 0.0) continue;  // its friction, which is none, does not change
    change.arrived |= bit(j);
  }
  if (change.arrived != 0) {
    change.slope = flow.sliding_speed(x, change.arriving()).slope;
  } else if (change.released >= 0) {
    const ValueAndSlope force = flow.stuck_force(x, before, change.released);
    change.slope = force.slope;
    change.side = force.value > 0.0 ? 1.0 : -1.0;
  }
  return change;
}

// All changes within a passage, one less than it has segments. Returns "" or why derivatives do not pass
// them.
template <int N, int H>
const char* find_changes(const Flow<N, H>& flow, std::span<const OrbitStep<N, H>> steps,
                         std::vector<ModeChange>& changes) {
  changes.clear();
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    if (!steps[i].ends_segment) continue;
    changes.push_back(
        mode_change(flow, flow.mode(steps[i].mode), steps[i].right, flow.mode(steps[i + 1].mode)));
    changes.back().step = i;
    if (changes.back().is_several()) return kSeveralArrive;
  }
  return "";
}

template <int N, int H>
class PassageSensitivity {
 public:
  using S = Sizes<N, H>;
  using Steps = std::span<const OrbitStep<N, H>>;

  explicit PassageSensitivity(const Flow<N, H>& flow) : flow_(flow) {}

  // The direction from now on; `by` must outlive what is asked below. To be called anew when the flow's
  // system or forcing has changed.
  void set_direction(const StepDerivative<N, H>& by);

  // delta over a passage from `start`, that of the state at its beginning; returns that at its end. The
  // steps, laid out and expanded, and the changes found in them must outlive what is asked below.
  typename S::State sweep(Steps steps, std::span<const ModeChange> changes, const typename S::State& start);

  // delta over the arrival of one contact, between the instants seen from inside the modes before and after.
  // Returns the derivative of its instant [steps].
  double arrive(const ModeChange& change, const Instant<N, H>& before, const Instant<N, H>& after,
                typename S::State& delta) const;

  // Taylor polynomials of delta over a step, a column for each component of the state.
  const typename S::StatePolynomials& polynomials(std::size_t step) const { return polynomials_[step]; }
  // At fraction `s` of a step, where the state is `at`.
  InstantDerivative<N, H> at(std::size_t step, double s, const Instant<N, H>& at) const;
  // Of lambda_j [N] of a contact that sticks in the mode, at instant x whose state changes by `delta`.
  double stuck_force(std::size_t mode, const Instant<N, H>& x, const typename S::State& delta,
                     Eigen::Index contact) const;
  const StepDerivative<N, H>& equations() const { return *by_; }
  // Derivative of the instant of a change within the passage [steps].
  double shift(std::size_t change) const { return shifts_[change]; }

 private:
  const ModeDerivative<N, H>& mode(std::size_t index);
  void expand(const OrbitStep<N, H>& step, const typename S::State& start, typename S::StatePolynomials& p);
  void enter(typename S::State& delta) const;
  double cross(const ModeChange& change, const OrbitStep<N, H>& before, const OrbitStep<N, H>& after,
               typename S::State& delta);

  const Flow<N, H>& flow_;
  Steps steps_;
  const StepDerivative<N, H>* by_ = nullptr;
  std::vector<ModeDerivative<N, H>> modes_;  // in the order of the flow's
  std::vector<bool> has_mode_;               // which of them are known
  std::vector<double> shifts_;
  std::vector<typename S::StatePolynomials> polynomials_;
};

template <int N, int H>
void PassageSensitivity<N, H>::set_direction(const StepDerivative<N, H>& by) {
  by_ = &by;
  has_mode_.clear();
}

template <int N, int H>
const ModeDerivative<N, H>& PassageSensitivity<N, H>::mode(std::size_t index) {
  if (index >= has_mode_.size()) has_mode_.resize(index + 1, false);
  if (index >= modes_.size()) modes_.resize(index + 1);
  if (!has_mode_[index]) modes_[index].set(flow_, flow_.mode(index), *by_);
  has_mode_[index] = true;
  return modes_[index];
}

template <int N, int H>
typename Sizes<N, H>::State PassageSensitivity<N, H>::sweep(Steps steps, std::span<const ModeChange> changes,
                                                            const typename S::State& start) {
  steps_ = steps;
  polynomials_.resize(std::max(polynomials_.size(), steps.size()));
  shifts_.resize(changes.size());
  typename S::State delta = start;
  enter(delta);
  std::size_t change = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const OrbitStep<N, H>& step = steps[i];
    expand(step, delta, polynomials_[i]);
    delta.noalias() = polynomials_[i].transpose() * powers(step.length);
    if (!step.ends_segment || i + 1 == steps.size()) continue;
    shifts_[change] = cross(changes[change], step, steps[i + 1], delta);
    ++change;
  }
  return delta;
}

// The Taylor series of delta over a step: coefficient k + 1 is the derivative of coefficient k over k + 1.
template <int N, int H>
void PassageSensitivity<N, H>::expand(const OrbitStep<N, H>& step, const typename S::State& start,
                                      typename S::StatePolynomials& p) {
  const StepEquations<N, H>& eq = flow_.equations();
  const Configuration<N, H>& c = flow_.configuration(flow_.mode(step.mode));
  const ModeDerivative<N, H>& d = mode(step.mode);
  const Expansion<N, H>& x = step.expansion;
  const Eigen::Index n = eq.masses(), internal = eq.internal_forces();
  Eigen::Matrix<double, kTerms, N> drive(kTerms, n);
  drive.noalias() = x.z * d.acceleration_z.transpose();
  drive.noalias() += x.u * d.acceleration_u.transpose();
  Eigen::Matrix<double, kTerms, S::kInternal> internal_drive(kTerms, internal);
  if constexpr (S::kInternal != 0) {
    internal_drive.noalias() = x.z * by_->internal_by_state.transpose();
    internal_drive.noalias() += x.u * by_->internal_drive.transpose();
  }
  p.resize(kTerms, eq.states());
  typename S::Vector q = start.head(n), v = start.segment(n, n), a(n);
  typename S::Internal s = start.tail(internal), ds(internal);
  for (int k = 0; k < kTerms; ++k) {
    p.row(k).head(n) = q.transpose();
    p.row(k).segment(n, n) = v.transpose();
    a.noalias() = c.Aq * q;
    a.noalias() += c.Av * v;
    a += drive.row(k).transpose();
    const double share = 1.0 / (k + 1.0);
    if constexpr (S::kInternal != 0) {
      p.row(k).tail(internal) = s.transpose();
      a += c.As * s;
      ds = eq.internal_stiffness.asDiagonal() * (eq.D.transpose() * v) - eq.internal_rate.asDiagonal() * s;
      s = (ds + internal_drive.row(k).transpose()) * share;
    }
    q = v * share;
    v = a * share;
  }
}

// Contacts that stick at the beginning: w_j^T v + p_j^T y' = 0 holds before and after.
template <int N, int H>
void PassageSensitivity<N, H>::enter(typename S::State& delta) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const Mode<N, H>& first = flow_.mode(steps_.front().mode);
  if (first.stuck == 0) return;
  const Eigen::Index n = eq.masses();
  const typename S::Contacts slip =
      eq.W.transpose() * delta.segment(n, n) + by_->support_velocity * steps_.front().left.u;
  delta.segment(n, n) -= flow_.configuration(first).reaction() * slip;
}

// What reaches its end at the change, g(z, p) = 0, does so later by dt = -dg / g'. Then
//   dv+ = dv- + (a- - a+) dt,
// and dv+ = dv- where a release alone leaves the acceleration as it is.
template <int N, int H>
double PassageSensitivity<N, H>::cross(const ModeChange& change, const OrbitStep<N, H>& before,
                                       const OrbitStep<N, H>& after, typename S::State& delta) {
  if (change.arrived != 0) return arrive(change, before.right, after.left, delta);
  if (change.released < 0) return 0.0;
  const Eigen::Index j = change.released;
  mode(before.mode);
  const double force = stuck_force(before.mode, before.right, delta, j);
  return (change.side * by_->limit[j] - force) / change.slope;
}

template <int N, int H>
double PassageSensitivity<N, H>::arrive(const ModeChange& change, const Instant<N, H>& before,
                                        const Instant<N, H>& after, typename S::State& delta) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses(), j = change.arriving();
  auto dv = delta.segment(n, n);
  const double velocity = eq.W.col(j).dot(dv) + by_->support_velocity.row(j).dot(before.u);
  const double shift = -velocity / change.slope;
  dv += (before.a - after.a) * shift;
  return shift;
}

template <int N, int H>
double PassageSensitivity<N, H>::stuck_force(std::size_t mode, const Instant<N, H>& x,
                                             const typename S::State& delta, Eigen::Index j) const {
  const Eigen::Index n = flow_.equations().masses();
  const Configuration<N, H>& c = flow_.configuration(flow_.mode(mode));
  const ModeDerivative<N, H>& d = modes_[mode];
  double force = c.Lq.row(j).dot(delta.head(n)) + c.Lv.row(j).dot(delta.segment(n, n));
  if constexpr (S::kInternal != 0) force += c.Ls.row(j).dot(delta.tail(flow_.equations().internal_forces()));
  return force + d.force_z.row(j).dot(x.z) + d.force_u.row(j).dot(x.u);
}

template <int N, int H>
InstantDerivative<N, H> PassageSensitivity<N, H>::at(std::size_t i, double s, const Instant<N, H>& at) const {
  const Eigen::Index n = flow_.equations().masses();
  const OrbitStep<N, H>& step = steps_[i];
  const Configuration<N, H>& c = flow_.configuration(flow_.mode(step.mode));
  const ModeDerivative<N, H>& d = modes_[step.mode];
  InstantDerivative<N, H> result;
  result.z = polynomials_[i].transpose() * powers(s);
  result.a = c.Aq * result.z.head(n) + c.Av * result.z.segment(n, n);
  if constexpr (S::kInternal != 0) result.a += c.As * result.z.tail(flow_.equations().internal_forces());
  result.a += d.acceleration_z * at.z + d.acceleration_u * at.u;
  return result;
}

}  // namespace frahm::periodic
