#pragma once

#include <span>
#include <vector>

#include "solvers/events/bend_guards.hpp"
#include "solvers/events/saltation.hpp"
#include "solvers/quantities/orbit_steps.hpp"
#include "solvers/quantities/step_derivative.hpp"

// The derivative of a motion over a passage, through its events, at fixed time in steps
// (step_derivative.hpp):
//   delta(t) = d z(t) / d p,   delta' = A delta + dA z + dB u + ...   between events,
// a jump where a contact comes to rest or reverses, a force reaches its limit, or an element bends.
// Sources: Leine and Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004, ch. 7;
// Hiskens and Pai, Trajectory sensitivity analysis of hybrid systems, IEEE Trans. Circuits Syst. I 47 (2000).
namespace frahm::periodic {

// State, acceleration and their derivative at one instant, seen from inside a mode.
template <int N, int H>
struct InstantDerivative {
  typename Sizes<N, H>::State z;
  typename Sizes<N, H>::Vector a;
};

inline constexpr const char* kSeveralArrive = "several contacts come to rest at one instant";
inline constexpr const char* kSeveralChange =
    "several contacts or elements change their state at one instant";

// Why no derivative exists across the changes of a passage; "" if it exists. Contacts that come to rest
// together may do so one after the other on either side, in either order; so may events of other
// kinds at which the acceleration jumps.
template <int N, int H>
const char* why_no_passage_derivative(const Flow<N, H>& flow, std::span<const Event> changes) {
  for (const Event& change : changes) {
    if (count(change.arrived & flow.equations().holding) > 1) return kSeveralArrive;
    if (change.jumps > 1 && !flow.equations().monotone) return kSeveralChange;
  }
  return "";
}

template <int N, int H>
class PassageSensitivity {
 public:
  using S = Sizes<N, H>;
  using Steps = std::span<const PassageStep<N, H>>;

  explicit PassageSensitivity(const Flow<N, H>& flow) : flow_(flow) {}

  // The direction from now on; `by` must outlive what is asked below. To be called anew when the flow's
  // system or forcing has changed.
  void set_direction(const StepDerivative<N, H>& by);

  // delta over a passage that begins with delta = `start`; returns delta at its end. The steps, laid out and
  // expanded, and the changes found in them must outlive what is asked below.
  typename S::State sweep(Steps steps, std::span<const Event> changes, const typename S::State& start);

  // delta over the arrival of contact j, whose velocity has the slope `slope` there, between the instants
  // seen from inside the modes before and after. Returns the derivative of its instant [steps].
  double arrive(Eigen::Index j, double slope, const Instant<N, H>& before, const Instant<N, H>& after,
                typename S::State& delta) const;
  // The same over the event of bend j, at its place or where its force vanishes.
  double bend(Eigen::Index j, BendGuard guard, double slope, const Instant<N, H>& before,
              const Instant<N, H>& after, typename S::State& delta) const;

  // Taylor polynomials of delta over a step, a column for each component of the state.
  const typename S::StatePolynomials& polynomials(std::size_t step) const { return polynomials_[step]; }
  // At fraction `s` of a step, where the state is `at`.
  InstantDerivative<N, H> at(std::size_t step, double s, const Instant<N, H>& at) const;
  // Derivative of lambda_j [N] of a contact stuck in the mode, at instant x whose state changes by `delta`.
  double stuck_force(std::size_t mode, const Instant<N, H>& x, const typename S::State& delta,
                     Eigen::Index contact) const;
  const StepDerivative<N, H>& equations() const { return *by_; }
  // Derivative of the instant of a change within the passage [steps].
  double shift(std::size_t change) const { return shifts_[change]; }

 private:
  const ModeDerivative<N, H>& mode(std::size_t index);
  void expand(const PassageStep<N, H>& step, const typename S::State& start, typename S::StatePolynomials& p);
  void enter(typename S::State& delta) const;
  double cross(const Event& change, const PassageStep<N, H>& before, const PassageStep<N, H>& after,
               typename S::State& delta);
  double let_go(const Event& change, const PassageStep<N, H>& before, const PassageStep<N, H>& after,
                typename S::State& delta);
  void keep_at_limit(ContactMask contacts, const Mode<N, H>& mode, typename S::State& delta) const;

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
typename Sizes<N, H>::State PassageSensitivity<N, H>::sweep(Steps steps, std::span<const Event> changes,
                                                            const typename S::State& start) {
  steps_ = steps;
  polynomials_.resize(std::max(polynomials_.size(), steps.size()));
  shifts_.resize(changes.size());
  typename S::State delta = start;
  enter(delta);
  std::size_t change = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const PassageStep<N, H>& step = steps[i];
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
void PassageSensitivity<N, H>::expand(const PassageStep<N, H>& step, const typename S::State& start,
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
    for (Eigen::Index i = 0; i < internal; ++i) {
      if (c.spring[i] == 0.0) internal_drive.col(i).setZero();  // it is held
    }
  }
  p.resize(kTerms, eq.states());
  typename S::Vector q = start.head(n), v = start.segment(n, n), a(n);
  typename S::Internal s = start.tail(internal), ds(internal);
  for (int k = 0; k < kTerms; ++k) {
    p.row(k).head(n) = q.transpose();
    p.row(k).segment(n, n) = v.transpose();
    c.pull(eq, q, v, s, a);
    a += drive.row(k).transpose();
    const double share = 1.0 / (k + 1.0);
    if constexpr (S::kInternal != 0) {
      p.row(k).tail(internal) = s.transpose();
      ds = c.internal_rates(eq, v, s);
      s = (ds + internal_drive.row(k).transpose()) * share;
    }
    q = v * share;
    v = a * share;
  }
}

// At the beginning w_j^T v + p_j^T y' = 0 of contacts that are held, and s = +-F of internal forces that are.
template <int N, int H>
void PassageSensitivity<N, H>::enter(typename S::State& delta) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const Mode<N, H>& first = flow_.mode(steps_.front().mode);
  keep_at_limit(~first.stuck & ~eq.holding, first, delta);
  if ((first.stuck & eq.holding) == 0) return;
  const Eigen::Index n = eq.masses();
  const typename S::Contacts slip =
      eq.W.transpose() * delta.segment(n, n) + by_->support_velocity * steps_.front().left.u;
  delta.segment(n, n) -= flow_.configuration(first).reaction(eq) * slip;
}

// s = sigma F of internal forces that slide in `mode`:  ds = sigma dF
template <int N, int H>
void PassageSensitivity<N, H>::keep_at_limit(ContactMask contacts, const Mode<N, H>& mode,
                                             typename S::State& delta) const {
  if constexpr (S::kInternal != 0) {
    const StepEquations<N, H>& eq = flow_.equations();
    for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
      if (!contains(contacts, j)) continue;
      delta[2 * eq.masses() + eq.internal_of[static_cast<std::size_t>(j)]] = mode.sign(j) * by_->limit[j];
    }
  }
}

// The guard g(z, p) = 0 of a change is reached later by dt = -dg / g'. Then with the fields before and after
//   dz+ = dz- + (f- - f+) dt:
// an arrival changes the acceleration, a release an internal force's rate. The acceleration also changes
// where a force falls from a static limit, and where a bend's force jumps. Nothing else jumps.
template <int N, int H>
double PassageSensitivity<N, H>::cross(const Event& change, const PassageStep<N, H>& before,
                                       const PassageStep<N, H>& after, typename S::State& delta) {
  if (change.bend < 0 && change.contact < 0) return 0.0;
  double shift = 0.0;
  if (change.bend >= 0) {
    const BendGuard guard = change.bend_by_force ? BendGuard::force : BendGuard::place;
    shift = bend(change.bend, guard, change.slope, before.right, after.left, delta);
  } else if (contains(change.arrived, change.contact)) {
    shift = arrive(change.contact, change.slope, before.right, after.left, delta);
  } else {
    shift = let_go(change, before, after, delta);
  }
  keep_at_limit(change.released & ~flow_.equations().holding, flow_.mode(after.mode), delta);
  return shift;
}

// Of a stuck force that reaches its limit, or of an idle contact's share that falls below it.
template <int N, int H>
double PassageSensitivity<N, H>::let_go(const Event& change, const PassageStep<N, H>& before,
                                        const PassageStep<N, H>& after, typename S::State& delta) {
  const Eigen::Index n = flow_.equations().masses();
  const bool shares = !contains(flow_.mode(before.mode).stuck, change.contact);
  const std::size_t sticking = shares ? after.mode : before.mode;
  mode(sticking);
  const double force = stuck_force(sticking, shares ? after.left : before.right, delta, change.contact);
  const double shift = (change.side * by_->static_limit[change.contact] - force) / change.slope;
  if (!shares && falls_at_release(flow_, flow_.mode(before.mode), flow_.mode(after.mode)))
    delta.segment(n, n) += (before.right.a - after.left.a) * shift;
  return shift;
}

template <int N, int H>
double PassageSensitivity<N, H>::arrive(Eigen::Index j, double slope, const Instant<N, H>& before,
                                        const Instant<N, H>& after, typename S::State& delta) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  auto dv = delta.segment(n, n);
  const double velocity = eq.W.col(j).dot(dv) + by_->support_velocity.row(j).dot(before.u);
  const double shift = -velocity / slope;
  if (eq.holds(j)) dv += (before.a - after.a) * shift;
  return shift;
}

template <int N, int H>
double PassageSensitivity<N, H>::bend(Eigen::Index j, BendGuard guard, double slope,
                                      const Instant<N, H>& before, const Instant<N, H>& after,
                                      typename S::State& delta) const {
  const StepBends<N, H>& bends = flow_.equations().bends;
  const Eigen::Index n = flow_.equations().masses();
  if (guard == BendGuard::force)
    return -bend_force_derivative<N, H>(bends, by_->bends, before, delta, j) / slope;
  const double shift = -bend_place_derivative<N, H>(bends, by_->bends, before, delta, j) / slope;
  if (contains(bends.jumping, j)) delta.segment(n, n) += (before.a - after.a) * shift;
  return shift;
}

template <int N, int H>
double PassageSensitivity<N, H>::stuck_force(std::size_t mode, const Instant<N, H>& x,
                                             const typename S::State& delta, Eigen::Index j) const {
  const ModeDerivative<N, H>& d = modes_[mode];
  return flow_.stuck_force_form(flow_.mode(mode), j).dot(delta) + d.force_z.row(j).dot(x.z) +
         d.force_u.row(j).dot(x.u);
}

template <int N, int H>
InstantDerivative<N, H> PassageSensitivity<N, H>::at(std::size_t i, double s, const Instant<N, H>& at) const {
  const Eigen::Index n = flow_.equations().masses();
  const PassageStep<N, H>& step = steps_[i];
  const Configuration<N, H>& c = flow_.configuration(flow_.mode(step.mode));
  const ModeDerivative<N, H>& d = modes_[step.mode];
  InstantDerivative<N, H> result;
  result.z = polynomials_[i].transpose() * powers(s);
  c.pull(flow_.equations(), result.z.head(n), result.z.segment(n, n),
         result.z.tail(flow_.equations().internal_forces()), result.a);
  result.a += d.acceleration_z * at.z + d.acceleration_u * at.u;
  return result;
}

}  // namespace frahm::periodic
