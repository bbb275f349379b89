#pragma once

#include "solvers/events/workspace.hpp"

// The first event within a step: the first root of a guard, of any contact.
//   a contact that slides:  its velocity reaches zero
//   a contact that sticks:  its force reaches the limit
//   a contact that is idle: its share of the others' forces falls below the limit (loops.hpp)
// No root is missed, not even a double root at grazing. Bounds of the fourth derivative decide from the ends
// of the step where they can; elsewhere the Bernstein coefficients of the Taylor polynomial decide.
namespace frahm::periodic {

struct GuardEvent {
  double at = 2.0;  // step fraction; beyond 1: none
  Eigen::Index contact = 0;
  bool release = false;  // a stuck contact's force reaches its limit; otherwise a sliding one comes to rest
  bool shares = false;   // or an idle contact shares the forces again
};
inline constexpr double kNoEvent = 2.0;

// The first sign change of p on (0, 1]. Where there is none, its closest approach to zero is a margin.
template <int N, int H>
double first_crossing(const Polynomial& p, double scale, Workspace<N, H>& w) {
  if (!may_change_sign(p)) return kNoEvent;
  const Roots roots = sign_changes(p);
  if (roots.count > 0) return roots.at[0];
  const Roots extremes = sign_changes(derivative(p));
  for (int i = 0; i < extremes.count; ++i) {
    const double closest = std::abs(evaluate(p, extremes.at[static_cast<std::size_t>(i)]));
    w.note_margin(closest / scale);
  }
  return kNoEvent;
}

// Where the room p between a stuck force and its limit becomes negative by more than a tie. A force that only
// touches its limit releases nothing.
template <int N, int H>
double first_lasting_fall(const Polynomial& p, double limit, Workspace<N, H>& w) {
  const double first = first_crossing(p, limit, w);
  if (first > 1.0 || evaluate_with_slope(p, first).slope < -1e-4 * limit) return first;
  const Roots extremes = sign_changes(derivative(p));
  double deepest = evaluate(p, 1.0);
  for (int i = 0; i < extremes.count; ++i) {
    const double at = extremes.at[static_cast<std::size_t>(i)];
    if (at > first) deepest = std::min(deepest, evaluate(p, at));
  }
  if (deepest < -kTie * limit) return first;
  w.margin = 0.0;
  return kNoEvent;
}

// The mode of which contact j's guard is: that of an idle one in which it shares the forces.
template <int N, int H>
const Mode<N, H>& guarded_mode(const Flow<N, H>& flow, Eigen::Index j, const Workspace<N, H>& w) {
  const Mode<N, H>& mode = flow.mode(w.mode);
  const bool is_idle = contains(flow.configuration(mode).idle, j);
  return is_idle ? flow.mode(w.sharing[static_cast<std::size_t>(j)]) : mode;
}

// The guard of contact j at an instant: its velocity, or its force while it sticks.
template <int N, int H>
ValueAndSlope guard_at(const Flow<N, H>& flow, const Instant<N, H>& at, const Mode<N, H>& mode,
                       Eigen::Index j) {
  return contains(mode.stuck, j) ? flow.stuck_force(at, mode, j) : flow.sliding_speed(at, j);
}

// The same over the step.
template <int N, int H>
Polynomial guard_polynomial(const Flow<N, H>& flow, Eigen::Index j, Workspace<N, H>& w) {
  const StepEquations<N, H>& eq = flow.equations();
  const Mode<N, H>& mode = guarded_mode(flow, j, w);
  if (!Sizes<N, H>::is_fixed && !eq.is_large()) return flow.guard(w.left, mode, j);
  const Expansion<N, H>& x = w.expand(flow);
  if (contains(mode.stuck, j)) return flow.stuck_force(x, mode, j);
  Polynomial speed = Polynomial::Zero();
  if (eq.is_large())
    for_each_entry(eq.sparse.directions, static_cast<int>(j),
                   [&](int i, double weight) { speed += weight * x.z.col(eq.masses() + i); });
  else
    speed = x.velocity(eq.W.col(j));
  if (flow.moving_support()) speed.noalias() += x.u * eq.support_velocity.row(j).transpose();
  return speed;
}

// When does sliding contact j come to rest within the step?
template <int N, int H>
double first_stop(const Flow<N, H>& flow, Eigen::Index j, ValueAndSlope left, ValueAndSlope right,
                  Workspace<N, H>& w) {
  const auto polynomial = [&] { return guard_polynomial(flow, j, w); };
  const double scale = w.speed_scale[j];
  if (scale == 0.0) return kNoEvent;
  if (contains(w.fresh, j)) {
    // The velocity starts like t, or like t^2 after a release: divide that root out.
    return first_crossing(deflate(polynomial(), contains(w.just_released, j) ? 2 : 1), scale, w);
  }
  if (flow.mode(w.mode).sign(j) * left.value <= 0.0) return 0.0;  // at the node itself, seen late by rounding
  switch (hermite_verdict(left, right, scale * kFourthDerivative / 384.0)) {
    case SignVerdict::no_change:
      return kNoEvent;
    case SignVerdict::one_change:
      return root_between(polynomial(), 0.0, 1.0);
    case SignVerdict::unclear:
      break;
  }
  return first_crossing(polynomial(), scale, w);
}

// How fast the force of contact j that is a state may seem to change at rest [N a step]: its spring times the
// rounding of the velocity. 0: its force is none.
template <int N, int H>
double rate_at_rest(const Flow<N, H>& flow, Eigen::Index j, const Workspace<N, H>& w) {
  const StepEquations<N, H>& eq = flow.equations();
  if (eq.holds(j)) return 0.0;
  return eq.internal_stiffness[eq.internal_of[static_cast<std::size_t>(j)]] * w.rest_speed[j];
}

// The room of a force that starts at its limit: the first coefficient that is not rounding decides. Negative:
// the contact lets go at once. Otherwise the root at the start is divided out. A force that is a state stays
// at its limit while others hold the contact. rate: rate_at_rest.
template <int N, int H>
double fall_from_limit(const Polynomial& room, double limit, double rate, Workspace<N, H>& w) {
  const bool is_state = rate > 0.0;
  if (is_state && room.cwiseAbs().sum() <= kTerms * kTie * limit) return kNoEvent;
  if (room[0] < -4.0 * kTie * limit) return 0.0;  // beyond the limit, as in a loop of contacts
  int multiplicity = std::abs(room[1]) <= std::max(kTie * limit, rate) ? 2 : 1;
  while (multiplicity > 1 && multiplicity < 4 && std::abs(room[multiplicity]) <= kTie * limit) ++multiplicity;
  const Polynomial rest = deflate(room, multiplicity);
  if (rest[0] >= 0.0) return first_lasting_fall(rest, limit, w);
  // A force whose room falls by less than a tie over the step, and rises again, only touches its limit.
  return rest[0] < -kTie * limit ? 0.0 : first_lasting_fall(room, limit, w);
}

// When does the force of stuck contact j reach its limit within the step?
template <int N, int H>
double first_release(const Flow<N, H>& flow, Eigen::Index j, ValueAndSlope left, ValueAndSlope right,
                     Workspace<N, H>& w) {
  const double limit = flow.equations().static_limit[j];
  const double margin = w.force_scale[j] * kFourthDerivative / 384.0;
  const double largest =
      std::max(std::max(std::abs(left.value), std::abs(right.value)),
               std::max(std::abs(left.value + left.slope / 3.0), std::abs(right.value - right.slope / 3.0)));
  if (largest + margin < limit) return kNoEvent;

  const Polynomial force = guard_polynomial(flow, j, w);
  double first = kNoEvent;
  for (const double side : {1.0, -1.0}) {
    Polynomial room = -side * force;
    room[0] += limit;
    const bool at_limit = room[0] <= kTie * limit;
    first = std::min(first, at_limit ? fall_from_limit(room, limit, rate_at_rest(flow, j, w), w)
                                     : first_lasting_fall(room, limit, w));
  }
  return first;
}

// When does the share of idle contact j fall below its limit within the step? The motion goes on unchanged
// there, however close to another outcome.
template <int N, int H>
double first_share(const Flow<N, H>& flow, Eigen::Index j, ValueAndSlope left, ValueAndSlope right,
                   Workspace<N, H>& w) {
  const double limit = flow.equations().static_limit[j], side = flow.mode(w.mode).sign(j);
  const double error = w.force_scale[j] * kFourthDerivative / 384.0;
  const double least =
      std::min(std::min(side * left.value, side * right.value),
               std::min(side * (left.value + left.slope / 3.0), side * (right.value - right.slope / 3.0)));
  if (least - error > limit) return kNoEvent;
  const double margin = w.margin;
  Polynomial excess = side * guard_polynomial(flow, j, w);
  excess[0] -= limit;
  const double first = excess[0] <= kTie * limit ? fall_from_limit(excess, limit, 0.0, w)
                                                 : first_lasting_fall(excess, limit, w);
  w.margin = margin;
  return first;
}

template <int N, int H>
GuardEvent first_event(const Flow<N, H>& flow, Workspace<N, H>& w) {
  GuardEvent first;
  const Mode<N, H>& mode = flow.mode(w.mode);
  const ContactMask idle = flow.configuration(mode).idle;
  for (Eigen::Index j = 0; j < flow.equations().contacts(); ++j) {
    if (contains(w.held & mode.stuck, j)) continue;
    const bool sticks = contains(mode.stuck, j), shares = contains(idle, j);
    if (shares && (!flow.equations().holds(j) || !flow.rests(mode, j))) continue;
    const Mode<N, H>& guarded = guarded_mode(flow, j, w);
    ValueAndSlope &left = w.left_guard[static_cast<std::size_t>(j)],
                  &right = w.right_guard[static_cast<std::size_t>(j)];
    if (!w.knows_left) left = guard_at(flow, w.left, guarded, j);
    right = guard_at(flow, w.right, guarded, j);
    const double at = sticks   ? first_release(flow, j, left, right, w)
                      : shares ? first_share(flow, j, left, right, w)
                               : first_stop(flow, j, left, right, w);
    if (at < first.at) first = {at, j, sticks, shares};
  }
  return first;
}

}  // namespace frahm::periodic
