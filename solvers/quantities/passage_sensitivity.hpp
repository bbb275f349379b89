#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "solvers/algebra/no_value.hpp"
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
inline constexpr const char* kGrazes =
    "grazing: an event only just happens, and the derivatives on both sides differ";

// What reaches its guard at an instant.
struct GuardReached {
  enum class Guard { velocity, stuck_force, bend_place, bend_force };
  Guard guard = Guard::velocity;
  Eigen::Index index = 0;  // of the contact or the bend
  double slope = 0.0;      // of the guard, seen from inside the mode before [m a step^2, N a step, m a step]
  bool jumps = false;      // the acceleration jumps with it
  double shift = 0.0;      // how much later it comes along the direction [steps]
  double size = 0.0;       // of the terms of that sum [steps]

  bool is_bend() const { return guard == Guard::bend_place || guard == Guard::bend_force; }
  static constexpr double kSameShift = 1e-9;
  bool is_shifted_as(const GuardReached& other) const {
    return std::abs(shift - other.shift) <= kSameShift * (size + other.size);
  }
};

template <int N, int H>
class PassageSensitivity {
 public:
  using S = Sizes<N, H>;
  using Steps = std::span<const PassageStep<N, H>>;

  explicit PassageSensitivity(const Flow<N, H>& flow) : flow_(flow) {}

  // The direction from now on; `by` must outlive what is asked below. To be called again when the flow's
  // system or forcing has changed.
  void set_direction(const StepDerivative<N, H>& by);

  // delta over a passage that begins with delta = `start`; returns delta at its end. The steps, laid out and
  // expanded, and the changes found in them must outlive what is asked below.
  typename S::State carry(Steps steps, std::span<const Event> changes, const typename S::State& start);

  // Counts the displacements of delta from offset + rate t, t in steps from the passage's beginning on.
  void ride_along(const Eigen::VectorXd& offset, const Eigen::VectorXd& rate) {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      polynomials_[i].row(0).head(rate.size()) -= (offset + steps_[i].start * rate).transpose();
      polynomials_[i].row(1).head(rate.size()) -= rate.transpose();
    }
  }

  // Why there is no derivative across the changes of the last passage; "" if there is one.
  const char* why_none() const { return why_none_; }

  // One side of a change: the mode there, and the instant seen from inside it.
  struct Side {
    std::size_t mode = 0;
    const Instant<N, H>& at;
  };
  // delta over a change.  Returns "" or why there is no derivative.
  const char* cross(const Event& change, const Side& before, const Side& after, typename S::State& delta);

  // Taylor polynomials of delta over a step, a column for each component of the state.
  const typename S::StatePolynomials& polynomials(std::size_t step) const { return polynomials_[step]; }
  // At fraction `s` of a step, where the state is `at`.
  InstantDerivative<N, H> at(std::size_t step, double s, const Instant<N, H>& at) const;
  // Derivative of lambda_j [N] of a contact stuck in the mode, at instant x whose state changes by `delta`.
  double stuck_force(std::size_t mode, const Instant<N, H>& x, const typename S::State& delta,
                     Eigen::Index contact) const;
  const StepDerivative<N, H>& equations() const { return *by_; }
  // Derivative of the instant of a change within the passage [steps]. NaN: what changes there is shifted
  // differently; each that does has its own, a contact NaN where its own depends on the order.
  double shift(std::size_t change) const { return shifts_[change]; }
  double shift_of_contact(std::size_t change, Eigen::Index contact) const {
    return own_shift(change, contact, false);
  }
  double shift_of_bend(std::size_t change, Eigen::Index bend) const { return own_shift(change, bend, true); }
  bool has_apart() const { return !own_shifts_.empty(); }  // some change is shifted in several ways

 private:
  const ModeDerivative<N, H>& mode(std::size_t index);
  void expand(const PassageStep<N, H>& step, const typename S::State& start, typename S::StatePolynomials& p);
  void enter(typename S::State& delta) const;
  void list_guards(const Event& change, const Side& before, const Side& after);
  void add_guard(typename GuardReached::Guard guard, Eigen::Index index, bool jumps, const Side& before);
  bool is_held(Eigen::Index bend, const Mode<N, H>& mode) const;
  void set_shift(GuardReached& reached, const Side& before, const typename S::State& delta);
  double common_shift(const Event& change, const Side& after, const typename S::State& delta);
  bool jump_alike(std::span<const GuardReached> reached) const;
  const char* jump(const Side& before, const Side& after, typename S::State& delta);
  const char* jump_apart(const Side& before, const Side& after, typename S::State& delta);
  void note_group(ContactMask contacts, double shift);
  void note_shifts(std::size_t change, const Side& before, const Side& after);
  double own_shift(std::size_t change, Eigen::Index index, bool of_bend) const;
  void hold(const Mode<N, H>& mode, const typename S::Oscillators& u, typename S::State& delta) const;
  void keep_at_limit(ContactMask contacts, const Mode<N, H>& mode, typename S::State& delta) const;

  struct OwnShift {
    std::size_t change = 0;
    Eigen::Index index = 0;
    bool of_bend = false;
    double shift = 0.0;
  };
  struct GroupShift {
    ContactMask contacts = 0;
    double shift = 0.0;
  };

  const Flow<N, H>& flow_;
  Steps steps_;
  const StepDerivative<N, H>* by_ = nullptr;
  std::vector<ModeDerivative<N, H>> modes_;  // in the order of the flow's
  std::vector<bool> has_mode_;               // which of them are known
  const char* why_none_ = "";
  std::vector<GuardReached> reached_;  // at the current change, those at which the acceleration jumps first
  bool is_apart_ = false;              // their shifts differ
  std::vector<GroupShift> group_shifts_;  // then those of contacts that jump together
  std::vector<double> shifts_;            // of each change
  std::vector<OwnShift> own_shifts_;      // where they differ
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
typename Sizes<N, H>::State PassageSensitivity<N, H>::carry(Steps steps, std::span<const Event> changes,
                                                            const typename S::State& start) {
  steps_ = steps;
  polynomials_.resize(std::max(polynomials_.size(), steps.size()));
  shifts_.resize(changes.size());
  own_shifts_.clear();
  why_none_ = "";
  typename S::State delta = start;
  enter(delta);
  std::size_t change = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const PassageStep<N, H>& step = steps[i];
    expand(step, delta, polynomials_[i]);
    delta.noalias() = polynomials_[i].transpose() * powers(step.length);
    if (!step.ends_segment || i + 1 == steps.size()) continue;
    const Side before{step.mode, step.right}, after{steps[i + 1].mode, steps[i + 1].left};
    const char* reason = cross(changes[change], before, after, delta);
    if (*why_none_ == '\0') why_none_ = reason;
    shifts_[change] = common_shift(changes[change], after, delta);
    if (is_apart_) note_shifts(change, before, after);
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
  if ((first.stuck & eq.holding) != 0) hold(first, steps_.front().left.u, delta);
}

// Takes up what violates  w_j^T dv + p_j^T dy' = 0  of the contacts held in `mode`, M-orthogonally.
template <int N, int H>
void PassageSensitivity<N, H>::hold(const Mode<N, H>& mode, const typename S::Oscillators& u,
                                    typename S::State& delta) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  const typename S::Contacts slip = eq.W.transpose() * delta.segment(n, n) + by_->support_velocity * u;
  delta.segment(n, n) -= flow_.configuration(mode).reaction(eq) * slip;
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
const char* PassageSensitivity<N, H>::cross(const Event& change, const Side& before, const Side& after,
                                            typename S::State& delta) {
  list_guards(change, before, after);
  for (GuardReached& reached : reached_) set_shift(reached, before, delta);
  is_apart_ = !jump_alike(reached_);
  group_shifts_.clear();
  const char* reason = jump(before, after, delta);
  const Mode<N, H>& mode = flow_.mode(after.mode);
  keep_at_limit(change.released & ~mode.stuck & ~flow_.equations().holding, mode, delta);
  return reason;
}

// Those at which the acceleration jumps come first.
template <int N, int H>
void PassageSensitivity<N, H>::list_guards(const Event& change, const Side& before, const Side& after) {
  using Guard = typename GuardReached::Guard;
  const StepEquations<N, H>& eq = flow_.equations();
  const Mode<N, H>&mode_before = flow_.mode(before.mode), &mode_after = flow_.mode(after.mode);
  const ContactMask turned = mode_before.beyond ^ mode_after.beyond, jumping = eq.bends.jumping;
  const auto add = [&](ContactMask which, Guard guard, bool jumps) {
    for (; which != 0; which &= which - 1) add_guard(guard, first(which), jumps, before);
  };
  // Contacts that let go only because of what else jumps reach no guard.
  ContactMask released = (change.released | change.let_go) & mode_before.stuck;
  for (ContactMask left = released & ~change.let_go; left != 0; left &= left - 1) {
    if (!is_at_limit(flow_, first(left), before.at, mode_before)) released &= ~bit(first(left));
  }
  ContactMask falls = falling(flow_, change.let_go & mode_before.stuck, before.at, mode_before, mode_after);
  ContactMask arrived = change.arrived, by_place = change.at_place & turned;
  if (arrived != 0) arrived &= ~flow_.at_rest(mode_before);
  for (ContactMask left = by_place & eq.bends.of_velocity; left != 0; left &= left - 1) {
    if (is_held(first(left), mode_before)) by_place &= ~bit(first(left));
  }
  reached_.clear();
  add(arrived & eq.holding, Guard::velocity, true);
  add(falls, Guard::stuck_force, true);
  add(by_place & jumping, Guard::bend_place, true);
  add(arrived & ~eq.holding, Guard::velocity, false);
  add(released & ~falls, Guard::stuck_force, false);
  add(by_place & ~jumping, Guard::bend_place, false);
  add(change.by_force & turned & ~change.at_place, Guard::bend_force, false);
}

template <int N, int H>
void PassageSensitivity<N, H>::add_guard(typename GuardReached::Guard guard, Eigen::Index index, bool jumps,
                                         const Side& before) {
  using Guard = typename GuardReached::Guard;
  GuardReached reached{.guard = guard, .index = index, .jumps = jumps};
  if (guard == Guard::velocity)
    reached.slope = flow_.sliding_speed(before.at, index).slope;
  else if (guard == Guard::stuck_force)
    reached.slope = flow_.stuck_force(before.at, flow_.mode(before.mode), index).slope;
  else
    reached.slope =
        bend_guard(flow_, before.at, guard == Guard::bend_place ? BendGuard::place : BendGuard::force, index)
            .slope;
  reached_.push_back(reached);
}

// Whether stuck contacts hold the velocity of a bend: it leaves its place because they let go.
template <int N, int H>
bool PassageSensitivity<N, H>::is_held(Eigen::Index bend, const Mode<N, H>& mode) const {
  constexpr double kHeld = 1e-9;
  const StepEquations<N, H>& eq = flow_.equations();
  if ((mode.stuck & eq.holding) == 0) return false;
  const auto b = eq.bends.B.col(bend);
  const typename S::Vector pull = eq.M_inverse * b;
  const typename S::Vector left =
      pull - flow_.configuration(mode).reaction(eq) * (eq.W.transpose() * pull).eval();
  return b.dot(left) <= kHeld * b.dot(pull);
}

template <int N, int H>
void PassageSensitivity<N, H>::set_shift(GuardReached& reached, const Side& before,
                                         const typename S::State& delta) {
  using Guard = typename GuardReached::Guard;
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses(), j = reached.index;
  const auto q = delta.head(n), v = delta.segment(n, n);
  double by = 0.0, size = 0.0;  // of the guard
  switch (reached.guard) {
    case Guard::velocity:
      by = eq.W.col(j).dot(v) + by_->support_velocity.row(j).dot(before.at.u);
      size = eq.W.col(j).cwiseAbs().dot(v.cwiseAbs());
      break;
    case Guard::stuck_force: {
      const Mode<N, H>& sticking = flow_.mode(before.mode);
      mode(before.mode);
      const double side = flow_.stuck_force(before.at, sticking, j).value > 0.0 ? 1.0 : -1.0;
      const double limit = side * by_->static_limit[j], force = stuck_force(before.mode, before.at, delta, j);
      by = force - limit;
      size = flow_.stuck_force_form(sticking, j).cwiseAbs().dot(delta.cwiseAbs()) + std::abs(limit);
      break;
    }
    case Guard::bend_place:
      by = bend_place_derivative<N, H>(eq.bends, by_->bends, before.at, delta, j);
      size = eq.bends.B.col(j).cwiseAbs().dot((contains(eq.bends.of_velocity, j) ? v : q).cwiseAbs());
      break;
    case Guard::bend_force:
      by = bend_force_derivative<N, H>(eq.bends, by_->bends, before.at, delta, j);
      size = eq.bends.B.col(j).cwiseAbs().dot(eq.bends.stiffness[j] * q.cwiseAbs() +
                                              eq.bends.damping[j] * v.cwiseAbs());
      break;
  }
  reached.shift = -by / reached.slope;
  reached.size = (size + std::abs(by)) / std::abs(reached.slope);
}

// For all that reached their guards, NaN where it differs; otherwise of an idle contact's share that falls
// below its limit.
template <int N, int H>
double PassageSensitivity<N, H>::common_shift(const Event& change, const Side& after,
                                              const typename S::State& delta) {
  if (!reached_.empty()) return is_apart_ ? kNone : reached_.front().shift;
  const Eigen::Index j = change.shares;
  const Mode<N, H>& sticking = flow_.mode(after.mode);
  if (j < 0 || !contains(sticking.stuck, j)) return 0.0;
  mode(after.mode);
  const double force = stuck_force(after.mode, after.at, delta, j);
  return (change.side * by_->static_limit[j] - force) / flow_.stuck_force(after.at, sticking, j).slope;
}

template <int N, int H>
bool PassageSensitivity<N, H>::jump_alike(std::span<const GuardReached> reached) const {
  for (std::size_t i = 1; i < reached.size(); ++i) {
    if (!reached[i].is_shifted_as(reached.front())) return false;
  }
  return true;
}

template <int N, int H>
const char* PassageSensitivity<N, H>::jump(const Side& before, const Side& after, typename S::State& delta) {
  std::size_t jumping = 0;
  while (jumping < reached_.size() && reached_[jumping].jumps) {
    if (reached_[jumping++].slope == 0.0) return kGrazes;
  }
  if (jumping == 0) return "";
  const Eigen::Index n = flow_.equations().masses();
  if (!jump_alike({reached_.data(), jumping})) return jump_apart(before, after, delta);
  delta.segment(n, n) += (before.at.a - after.at.a) * reached_.front().shift;
  note_group(~ContactMask{0}, reached_.front().shift);
  return "";
}

// Several guards, shifted by different times. Whatever does not feel the others jumps by itself. Of what does
// the forces of bends add up, as they depend on the velocity alone, which is continuous; and contacts that
// all stick in the end reduce delta to its M-orthogonal projection onto the velocities that keep them stuck,
// in whatever order and way they came to it, as their impulses act along their own directions. Otherwise the
// order decides, and it is another one on either side.
template <int N, int H>
const char* PassageSensitivity<N, H>::jump_apart(const Side& before, const Side& after,
                                                 typename S::State& delta) {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  const Mode<N, H>&mode_before = flow_.mode(before.mode), &mode_after = flow_.mode(after.mode);
  ContactMask contacts = (flow_.at_rest(mode_before) | flow_.at_rest(mode_after)) & eq.holding, bends = 0;
  bool all_arrive = true;
  for (const GuardReached& each : reached_) {
    if (each.jumps) (each.is_bend() ? bends : contacts) |= bit(each.index);
    all_arrive = all_arrive && (!each.jumps || each.guard == GuardReached::Guard::velocity);
  }
  const CoupledGroups<N, H> groups(eq, contacts, bends);
  auto dv = delta.segment(n, n);
  bool caught = false;
  for (std::size_t g = 0; g < groups.count(); ++g) {
    std::vector<GuardReached> its;
    for (const GuardReached& each : reached_) {
      if (each.jumps && contains(each.is_bend() ? groups.bends(g) : groups.contacts(g), each.index))
        its.push_back(each);
    }
    if (its.empty()) continue;
    if (jump_alike(its)) {
      dv += groups.part(g, before.at.a - after.at.a) * its.front().shift;
      note_group(groups.contacts(g), its.front().shift);
    } else if ((groups.contacts(g) & ~flow_.at_rest(mode_after)) == 0) {
      for (const GuardReached& each : its) {
        if (!each.is_bend()) continue;
        const double force = bend_force(flow_, before.at, each.index).value;
        const double rises = contains(mode_after.beyond, each.index) ? force : -force;
        dv += eq.M_inverse * eq.bends.B.col(each.index) * (rises * each.shift);
      }
      caught = caught || groups.contacts(g) != 0;
    } else {
      return all_arrive ? kSeveralArrive : kSeveralChange;
    }
  }
  if (caught) hold(mode_after, after.at.u, delta);
  return "";
}

template <int N, int H>
void PassageSensitivity<N, H>::note_group(ContactMask contacts, double shift) {
  if (is_apart_) group_shifts_.push_back({contacts, shift});
}

// The shifts of what reached a guard, where they differ, and of contacts that come to rest or let go with it.
// That of a contact is known if its force is a state, or if no other jump comes before or after it.
template <int N, int H>
void PassageSensitivity<N, H>::note_shifts(std::size_t change, const Side& before, const Side& after) {
  const StepEquations<N, H>& eq = flow_.equations();
  const bool jumps = !reached_.empty() && reached_.front().jumps;
  ContactMask turned = flow_.at_rest(flow_.mode(before.mode)) ^ flow_.at_rest(flow_.mode(after.mode));
  const auto of_group = [&](Eigen::Index j) {
    for (const GroupShift& group : group_shifts_) {
      if (contains(group.contacts, j)) return group.shift;
    }
    return kNone;
  };
  for (const GuardReached& each : reached_) {
    double own = each.shift;
    if (!each.is_bend()) {
      const bool of_state = each.guard == GuardReached::Guard::stuck_force && !eq.holds(each.index);
      const double together = of_group(each.index);
      const bool is_known =
          of_state || !jumps || std::abs(own - together) <= GuardReached::kSameShift * each.size;
      if (!is_known) own = kNone;
      turned &= ~bit(each.index);
    }
    own_shifts_.push_back({change, each.index, each.is_bend(), own});
  }
  for (; turned != 0; turned &= turned - 1)
    own_shifts_.push_back({change, first(turned), false, of_group(first(turned))});
}

// Where the change has no shift of its own for it, the common one.
template <int N, int H>
double PassageSensitivity<N, H>::own_shift(std::size_t change, Eigen::Index index, bool of_bend) const {
  for (const OwnShift& own : own_shifts_) {
    if (own.change == change && own.index == index && own.of_bend == of_bend) return own.shift;
  }
  return shifts_[change];
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
