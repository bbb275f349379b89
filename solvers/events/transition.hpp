#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <vector>

#include "solvers/events/bend_guards.hpp"
#include "solvers/events/box_minimum.hpp"
#include "solvers/events/loops.hpp"
#include "solvers/events/parted_supports.hpp"
#include "solvers/events/passage.hpp"
#include "solvers/events/workspace.hpp"

// Which contacts stick and which slide after an event. The cases:
//
//   what happened                        law's answer            what follows
//   a stuck force reaches its limit      -                       it slides in the force's direction; a force
//                                                                that is a state stays there. One that falls
//                                                                to its sliding force takes along what it
//                                                                held: all at rest with it are chosen again
//   a sliding velocity reaches zero      it holds a velocity     the forces of all at rest solve one convex
//                                                                problem: inside its limit a contact sticks,
//                                                                at its limit it slides that way. Where
//                                                                some hold more at rest: joint_choice.hpp
//                                        its force is a state    it sticks
//   a stuck force is at its limit        -                       it lets go at once (two contacts released
//   and grows after all this                                     together, or one that came to rest in a tie)
//   in a loop of contacts a stuck        -                       the others hold it and it carries its limit,
//   force reaches its limit                                      or some slide (loops.hpp)
namespace frahm::periodic {

// Sliding contacts that come to rest at this event: its own contact, and others at the same instant.
template <int N, int H>
ContactMask arrivals(const Flow<N, H>& flow, Eigen::Index own, const Workspace<N, H>& w) {
  const Mode<N, H>& mode = flow.mode(w.mode);
  const ContactMask idle = flow.configuration(mode).idle;
  ContactMask arrived = own < 0 ? 0 : bit(own);
  for (Eigen::Index j = 0; j < flow.equations().contacts(); ++j) {
    if (contains(mode.stuck | arrived | w.fresh | idle, j)) continue;
    const ValueAndSlope speed = flow.sliding_speed(w.left, j);
    const double sign = mode.sign(j);
    if (sign * speed.value <= w.rest_speed[j] && sign * speed.slope < 0.0) arrived |= bit(j);
  }
  return arrived;
}

// The relative accelerations c_j = w_j^T a + p_j^T y'' of contacts if those at rest had no friction.
template <int N, int H>
class FreeAccelerations {
 public:
  FreeAccelerations(const Flow<N, H>& flow, ContactMask at_rest, const Workspace<N, H>& w)
      : equations_(flow.equations()), u_(w.left.u) {
    const StepEquations<N, H>& eq = equations_;
    const Mode<N, H>& mode = flow.mode(w.mode);
    typename Sizes<N, H>::Contacts friction = mode.friction;
    for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
      if (contains(at_rest, j)) friction[j] = 0.0;
    }
    const Eigen::Index n = eq.masses();
    if (eq.is_large()) {
      const auto& z = w.left.z;
      Eigen::VectorXd a(n), ds(eq.internal_forces());
      HeldContacts none;
      none.spring.setZero(ds.size());
      pull(eq.sparse, none, z.data(), z.data() + n, z.data() + 2 * n, a.data(), ds.data());
      acceleration_ = a + eq.force_pull * u_ - eq.MW * friction;
    } else {
      typename Sizes<N, H>::Vector force =
          eq.force * u_ - eq.K * w.left.z.head(n) - eq.C * w.left.z.segment(n, n) - eq.W * friction;
      if constexpr (Sizes<N, H>::kInternal != 0) force -= eq.D * w.left.z.tail(eq.internal_forces());
      acceleration_ = eq.M_inverse * force;
    }
    for (Eigen::Index j = 0; mode.beyond != 0 && j < eq.bends.count(); ++j) {
      if (contains(mode.beyond, j)) acceleration_ -= bend_force(flow, w.left, j).value * eq.bends.MB.col(j);
    }
  }
  double of(Eigen::Index j) const {
    return equations_.W.col(j).dot(acceleration_) + equations_.support_acceleration.row(j).dot(u_) +
           (parted_.size() > 0 ? parted_[j] : 0.0);
  }
  // Adds what supports that part are about to add.
  void add(const Eigen::VectorXd& parted) { parted_ = parted; }

 private:
  const StepEquations<N, H>& equations_;
  const typename Sizes<N, H>::Oscillators& u_;
  typename Sizes<N, H>::Vector acceleration_;
  Eigen::VectorXd parted_;
};

// A single contact: it sticks if the force needed for this, c/G, is within the limit.
template <int N, int H>
Choice choose_alone(const StepEquations<N, H>& eq, Eigen::Index j, double c, Workspace<N, H>& w) {
  const double force = c / eq.compliance[j], limit = eq.static_limit[j];
  if (contains(w.held, j)) return {bit(j), 0};
  if (limit > 0.0) w.note_margin(std::abs(std::abs(force) - limit) / limit);
  if (std::abs(force) <= limit * (1.0 + kTie) && limit > 0.0) return {bit(j), 0};
  return {0, force > 0.0 ? bit(j) : 0};
}

// Several contacts: their forces minimise  1/2 lambda^T G lambda - c^T lambda,  |lambda_j| <= F_j,
// G = W^T M^-1 W (Glocker, Set-Valued Force Laws, 2001, ch. 9).
template <int N, int H>
Choice choose_together(const StepEquations<N, H>& eq, ContactMask at_rest,
                       const FreeAccelerations<N, H>& free, Workspace<N, H>& w) {
  constexpr double kWithoutLimit = 1e9, kRounding = 16.0 * std::numeric_limits<double>::epsilon();
  const std::vector<Eigen::Index> contacts = list_of(at_rest);
  const auto m = static_cast<Eigen::Index>(contacts.size());
  const auto contact = [&](Eigen::Index i) { return contacts[static_cast<std::size_t>(i)]; };
  Eigen::MatrixXd G(m, m);
  Eigen::VectorXd c(m), weight(m), bound(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index j = contact(i);
    for (Eigen::Index k = 0; k < m; ++k) G(i, k) = eq.mobility(j, contact(k));
    c[i] = free.of(j);
    weight[i] = eq.limit[j] > 0.0 ? eq.limit[j] : 1.0;
    bound[i] = contains(w.held, j) ? kWithoutLimit * weight[i] : eq.limit[j];
  }
  const BoxMinimum minimum = box_minimum(G, c, -bound, bound, weight);
  if (!minimum.found) w.undecided = kNotFound;
  const Eigen::VectorXd& force = minimum.lambda;
  const Eigen::VectorXd acceleration = c - G * force;

  Choice choice;
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index j = contact(i);
    const double limit = eq.limit[j];
    const double size = G(i, i) * weight[i] + std::abs(c[i]);
    const double pull = std::abs(acceleration[i]) / size;
    // For the sum c - G lambda: that of a weak contact next to strong ones.
    const double rounding = kRounding * G.row(i).cwiseAbs().dot(force.cwiseAbs()) / size;
    const double room = (limit - std::abs(force[i])) / weight[i];
    const bool sticks = pull <= std::max(kTie, rounding) && limit > 0.0;
    if (sticks && room <= kTie && !contains(w.held, j))
      choice.at_limit |= bit(j);
    else if (limit > 0.0 && !contains(w.held, j))
      w.note_margin(std::max(pull, room));
    if (sticks)
      choice.stuck |= bit(j);
    else if (limit > 0.0 ? force[i] > 0.0 : acceleration[i] > 0.0)
      choice.forward |= bit(j);
  }
  return choice;
}

// Contacts that stick with forces at their limits are about to slide, unless the others hold them too.
template <int N, int H>
void note_limits(Flow<N, H>& flow, const Choice& choice, Workspace<N, H>& w) {
  const ContactMask inside = choice.stuck & ~choice.at_limit;
  const std::size_t without = flow.mode_index(inside, 0, flow.mode(w.mode).beyond);
  if ((choice.at_limit & ~flow.configuration(flow.mode(without)).idle) != 0) w.note_margin(0.0);
}

// The choice for contacts at rest. letting_go: one of them whose force has reached its limit here.
template <int N, int H>
Choice choose(Flow<N, H>& flow, ContactMask at_rest, ContactMask letting_go,
              const FreeAccelerations<N, H>& free, Workspace<N, H>& w) {
  const StepEquations<N, H>& eq = flow.equations();
  ContactMask falling = in_falling_groups(eq, at_rest);
  const ContactMask others = at_rest & ~falling;
  Choice choice;
  if (count(others) == 1)
    choice = choose_alone(eq, first(others), free.of(first(others)), w);
  else if (others != 0)
    choice = choose_together(eq, others, free, w);
  while (falling != 0) {
    const ContactMask group = acting_together(eq, falling, first(falling));
    falling &= ~group;
    if (count(group) == 1 && (group & letting_go) == 0) {
      choice = choice | choose_alone(eq, first(group), free.of(first(group)), w);
      continue;
    }
    const std::vector<Eigen::Index> contacts = list_of(group);
    Eigen::VectorXd c(static_cast<Eigen::Index>(contacts.size()));
    for (std::size_t i = 0; i < contacts.size(); ++i) c[static_cast<Eigen::Index>(i)] = free.of(contacts[i]);
    const Choice beside = choice | Choice{.stuck = falling};
    choice = choice | choose_group(flow, group, letting_go & group, c, at_rest, beside, w);
  }
  return choice;
}

// The mode in which all contacts at rest whose velocity is held are chosen together.
template <int N, int H>
void choose_modes(Flow<N, H>& flow, ContactMask at_rest, Workspace<N, H>& w, ContactMask letting_go = 0) {
  const StepEquations<N, H>& eq = flow.equations();
  FreeAccelerations<N, H> free(flow, at_rest, w);
  Choice choice = choose(flow, at_rest, letting_go, free, w);
  if (eq.has_loops && flow.moving_support() && are_parted(eq, choice.stuck)) {
    free.add(parting(eq, w.left));
    const ContactMask stuck_now = choice.stuck;
    choice = choose(flow, at_rest, letting_go, free, w);
    choice.slow |= stuck_now & ~choice.stuck;
  }
  start_chosen(flow, at_rest, choice, w);
  if (choice.at_limit != 0) note_limits(flow, choice, w);
}

// A stuck contact lets go. A held contact starts from rest, without relative acceleration unless its force
// falls from a static limit; an internal force stays at its limit and the velocity does not change.
template <int N, int H>
void release(Flow<N, H>& flow, Eigen::Index j, bool forward, Workspace<N, H>& w) {
  const Mode<N, H>& before = flow.mode(w.mode);
  if (flow.equations().holds(j)) {
    w.fresh |= bit(j);
    if (flow.equations().static_limit[j] == flow.equations().limit[j]) w.just_released |= bit(j);
  } else {
    const Eigen::Index internal = flow.equations().internal_of[static_cast<std::size_t>(j)];
    w.left.z[2 * flow.equations().masses() + internal] = (forward ? 1.0 : -1.0) * flow.equations().limit[j];
    if (std::abs(flow.sliding_speed(w.left, j).value) <= w.rest_speed[j]) w.fresh |= bit(j);
  }
  w.mode = flow.mode_index(before.stuck & ~bit(j), before.positive | (forward ? bit(j) : 0), before.beyond);
}

// The stuck contact j lets go. Where forces fall with its own, all that are at rest with it are chosen again.
template <int N, int H>
void let_go(Flow<N, H>& flow, Eigen::Index j, bool forward, Workspace<N, H>& w) {
  const StepEquations<N, H>& eq = flow.equations();
  if (!eq.monotone && eq.holds(j)) {
    const ContactMask group = acting_together(eq, at_rest(flow, w), j);
    if (count(group) > 1 && some_fall(eq, group)) return choose_modes(flow, group, w, bit(j));
  }
  release(flow, j, forward, w);
}

// The stuck contact j of a loop lets go although others seemed to hold it: their limits are reached with its
// own, to rounding. Those that it held in turn start from rest with it.
template <int N, int H>
void let_go_in_loop(Flow<N, H>& flow, Eigen::Index j, Workspace<N, H>& w) {
  const ContactMask stuck = flow.mode(w.mode).stuck, rested = at_rest(flow, w);
  const bool forward = flow.stuck_force(w.left, flow.mode(w.mode), j).value > 0.0;
  let_go(flow, j, forward, w);
  if (flow.mode(w.mode).stuck == stuck) release(flow, j, forward, w);
  const ContactMask with_it = rested & ~at_rest(flow, w) & ~w.fresh;
  w.fresh |= with_it;
  for (const Eigen::Index i : list_of(with_it)) {
    if (flow.equations().static_limit[i] == flow.equations().limit[i]) w.just_released |= bit(i);
  }
}

// Stuck contacts whose force is at its limit and grows let go at once.
template <int N, int H>
void release_at_limits(Flow<N, H>& flow, Workspace<N, H>& w) {
  for (bool again = true; again;) {
    again = false;
    for (Eigen::Index j = 0; j < flow.equations().contacts(); ++j) {
      const Mode<N, H>& mode = flow.mode(w.mode);
      if (!contains(mode.stuck & ~w.held & ~w.settled & flow.equations().holding, j)) continue;
      const ValueAndSlope force = flow.stuck_force(w.left, mode, j);
      const double side = force.value > 0.0 ? 1.0 : -1.0;
      const double limit = flow.equations().static_limit[j], size = side * force.value;
      if (size < limit * (1.0 - kTie) || (side * force.slope <= 0.0 && size <= limit * (1.0 + 1e-9)))
        continue;
      let_go(flow, j, side > 0.0, w);
      again = true;
    }
  }
}

// Removes rounding from the velocities of contacts that now stick, and decides of those at their limits.
// letting_go: one of a loop, whose force has reached its limit (0: none).
template <int N, int H>
void settle_mode(Flow<N, H>& flow, ContactMask letting_go, Workspace<N, H>& w) {
  flow.configuration(flow.mode(w.mode)).hold(flow.equations(), w.left.u, w.left.z);
  flow.accelerate(flow.mode(w.mode), w.left);
  if (flow.equations().has_loops) {
    const ContactMask slid = hold_together(flow, letting_go, w);
    const ContactMask stuck = flow.mode(w.mode).stuck;
    if (slid == 0 && (letting_go & stuck) != 0) let_go_in_loop(flow, first(letting_go), w);
    if (letting_go != 0) slide_on(flow, w);
  } else {
    release_at_limits(flow, w);
  }
  flow.accelerate(flow.mode(w.mode), w.left);
  w.settled = 0;
}

// The mode after the contacts of `arrived` came to rest, and the contact `released` (-1: none) let go forward
// or backward.
template <int N, int H>
void change_mode(Flow<N, H>& flow, ContactMask arrived, Eigen::Index released, bool forward,
                 Workspace<N, H>& w) {
  const StepEquations<N, H>& eq = flow.equations();
  const ContactMask holding = eq.holding, held_now = arrived & holding;
  ContactMask letting_go = 0;
  const bool holds = released >= 0 && contains(holding, released);
  if (released >= 0) {
    const bool with_arrivals =
        holds && held_now != 0 && contains(in_falling_groups(eq, at_rest(flow, w) | held_now), released);
    if (holds && (eq.has_loops || with_arrivals))
      letting_go = bit(released);
    else
      let_go(flow, released, forward, w);
    if (holds && letting_go == 0) slide_on(flow, w);
  }
  if (const ContactMask states = arrived & ~holding; states != 0) {
    const Mode<N, H>& mode = flow.mode(w.mode);
    w.mode = flow.mode_index(mode.stuck | states, mode.positive, mode.beyond);
  }
  if (held_now != 0) choose_modes(flow, at_rest(flow, w) | held_now, w, letting_go);
  if (holds && !eq.has_loops && letting_go != 0) slide_on(flow, w);
  letting_go &= ~w.settled;
  settle_mode(flow, letting_go, w);
}

}  // namespace frahm::periodic
