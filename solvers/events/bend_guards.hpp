#pragma once

#include "solvers/events/workspace.hpp"

// When do elements bend (laws/bend.hpp)? Each bend is in one of three states, and watches up to two guards:
// its place g = u - D (or u' - D), and its force r = k g + c g'.
//
//   state      watches                              then
//   before     g rises through zero                 beyond
//   beyond     pulling: g falls through zero        before
//              else:    r falls through zero        free, if g > 0 still
//   free       r rises through zero                 beyond
//              g falls through zero                 before
namespace frahm::periodic {

enum class BendGuard { place, force };

// g of bend j and its slope a step.
template <int N, int H>
ValueAndSlope bend_place(const Flow<N, H>& flow, const Instant<N, H>& at, Eigen::Index j) {
  const StepBends<N, H>& bends = flow.equations().bends;
  const Eigen::Index n = flow.equations().masses();
  const auto b = bends.B.col(j);
  const auto q = at.z.head(n), v = at.z.segment(n, n);
  if (contains(bends.of_velocity, j))
    return {b.dot(v) + bends.motion_velocity.row(j).dot(at.u) - bends.place[j],
            b.dot(at.a) + bends.motion_acceleration.row(j).dot(at.u)};
  return {b.dot(q) + bends.motion.row(j).dot(at.u) - bends.place[j],
          b.dot(v) + bends.motion_velocity.row(j).dot(at.u)};
}

// The force of bend j beyond its place [N], and its slope a step.
template <int N, int H>
ValueAndSlope bend_force(const Flow<N, H>& flow, const Instant<N, H>& at, Eigen::Index j) {
  const StepBends<N, H>& bends = flow.equations().bends;
  const double k = bends.stiffness[j], c = bends.damping[j];
  const ValueAndSlope g = bend_place(flow, at, j);
  if (contains(bends.of_velocity, j)) return {c * g.value, c * g.slope};
  const double rate = bends.B.col(j).dot(at.a) + bends.motion_acceleration.row(j).dot(at.u);
  return {k * g.value + c * g.slope, k * g.slope + c * rate};
}

template <int N, int H>
ValueAndSlope bend_guard(const Flow<N, H>& flow, const Instant<N, H>& at, BendGuard guard, Eigen::Index j) {
  return guard == BendGuard::place ? bend_place(flow, at, j) : bend_force(flow, at, j);
}

// The guard over the current step.
template <int N, int H>
Polynomial bend_polynomial(const Flow<N, H>& flow, BendGuard guard, Eigen::Index j, Workspace<N, H>& w) {
  const StepBends<N, H>& bends = flow.equations().bends;
  const Expansion<N, H>& x = w.expand(flow);
  const auto place = [&] {
    Polynomial g = x.displacement(bends.B.col(j));
    g.noalias() += x.u * bends.motion.row(j).transpose();
    g[0] -= bends.place[j];
    return g;
  };
  const auto velocity = [&] {
    Polynomial g = x.velocity(bends.B.col(j));
    g.noalias() += x.u * bends.motion_velocity.row(j).transpose();
    return g;
  };
  if (contains(bends.of_velocity, j)) {
    Polynomial g = velocity();
    g[0] -= bends.place[j];
    return g;
  }
  if (guard == BendGuard::place) return place();
  return bends.stiffness[j] * place() + bends.damping[j] * velocity();
}

// The fraction of the step at which the guard, which has the sign `side` before, changes it. fresh: the guard
// is zero at the start of the step, a root that is divided out. A place on which contacts hold the bend, such
// as zero velocity next to friction that sticks, is never passed.
template <int N, int H>
double first_guard(const Flow<N, H>& flow, BendGuard guard, Eigen::Index j, double side, bool fresh,
                   Workspace<N, H>& w) {
  constexpr double kNever = 2.0;
  Polynomial p = side * bend_polynomial(flow, guard, j, w);
  const double size = p.cwiseAbs().sum();
  if (guard == BendGuard::place && size <= w.at_rest_on_place[j]) return kNever;
  if (fresh) {
    int multiplicity = 1;
    while (multiplicity < 4 && std::abs(p[multiplicity]) <= kRest * size) ++multiplicity;
    p = deflate(p, multiplicity);
  }
  if (p[0] <= 0.0) return 0.0;
  if (p.tail<kTerms - 1>().cwiseAbs().sum() < p[0]) return kNever;
  const Roots roots = sign_changes(p);
  if (roots.count > 0) return roots.at[0];
  // A force that jumps makes the closest approach a matter of touching or not.
  if (guard == BendGuard::place && contains(flow.equations().bends.jumping, j)) {
    const Roots extremes = sign_changes(derivative(p));
    for (int i = 0; i < extremes.count; ++i)
      w.note_margin(evaluate(p, extremes.at[static_cast<std::size_t>(i)]) / (p.cwiseAbs().sum()));
  }
  return kNever;
}

struct BendEvent {
  double at = 2.0;  // step fraction; beyond 1: none
  Eigen::Index bend = 0;
  BendGuard guard = BendGuard::place;
};

template <int N, int H>
BendEvent first_bend(const Flow<N, H>& flow, Workspace<N, H>& w) {
  const StepBends<N, H>& bends = flow.equations().bends;
  const ContactMask beyond = flow.mode(w.mode).beyond;
  BendEvent first;
  const auto look = [&](Eigen::Index j, BendGuard guard, double side) {
    const ContactMask fresh = guard == BendGuard::place ? w.at_place : w.without_force;
    const double at = first_guard(flow, guard, j, side, contains(fresh, j), w);
    if (at < first.at) first = {at, j, guard};
  };
  for (Eigen::Index j = 0; j < bends.count(); ++j) {
    if (contains(w.free, j)) {
      look(j, BendGuard::force, -1.0);
      look(j, BendGuard::place, +1.0);
    } else if (!contains(beyond, j)) {
      look(j, BendGuard::place, -1.0);
    } else {
      look(j, contains(bends.pulling, j) ? BendGuard::place : BendGuard::force, +1.0);
    }
  }
  return first;
}

// The state of every bend at the start of a passage.
template <int N, int H>
ContactMask bends_at_start(const Flow<N, H>& flow, Workspace<N, H>& w) {
  const StepBends<N, H>& bends = flow.equations().bends;
  ContactMask beyond = 0;
  w.free = w.at_place = w.without_force = 0;
  for (Eigen::Index j = 0; j < bends.count(); ++j) {
    const ValueAndSlope g = bend_place(flow, w.left, j);
    const double size = std::abs(g.value) + std::abs(g.slope) + std::abs(bends.place[j]);
    const bool is_at_place = std::abs(g.value) <= kRest * size;
    if (is_at_place) w.at_place |= bit(j);
    if (is_at_place ? g.slope <= 0.0 : g.value < 0.0) continue;
    const bool pushes = contains(bends.pulling, j) || bend_force(flow, w.left, j).value > 0.0;
    (pushes ? beyond : w.free) |= bit(j);
  }
  return beyond;
}

// The mode after the event of a bend.
template <int N, int H>
void change_bend(Flow<N, H>& flow, const BendEvent& event, Workspace<N, H>& w) {
  const Mode<N, H>& before = flow.mode(w.mode);
  const ContactMask its = bit(event.bend);
  (event.guard == BendGuard::place ? w.at_place : w.without_force) |= its;
  const bool was_beyond = contains(before.beyond, event.bend), was_free = contains(w.free, event.bend);
  w.free &= ~its;
  if (was_free && event.guard == BendGuard::place) return;  // it pushed no more: the mode stays
  if (was_beyond && event.guard == BendGuard::force && bend_place(flow, w.left, event.bend).value > 0.0)
    w.free |= its;
  w.mode = flow.mode_index(before.stuck, before.positive, before.beyond ^ its);
}

}  // namespace frahm::periodic
