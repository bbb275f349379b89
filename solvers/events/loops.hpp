#pragma once

#include <vector>

#include "solvers/events/joint_choice.hpp"
#include "solvers/events/passage.hpp"
#include "solvers/events/rest_problem.hpp"
#include "solvers/events/workspace.hpp"

// Contacts in loops: where stuck contacts alone hold a further contact at rest, motion says nothing of its
// force. By convention the forces are those of least sum (lambda_j / F_j)^2 within the limits. A contact that
// its limit keeps from its share carries the limit, as if it slid, while the others hold it: it is idle
// (Configuration::idle). It shares again at the instant at which its share is within its limit. So forces
// depend on the state alone, not on what came before; no force exceeds its limit, and motion begins only
// where no distribution of the forces can hold the contacts.
namespace frahm::periodic {

// The contacts at rest whose velocity is held: those that stick, and those that they hold.
template <int N, int H>
ContactMask at_rest(const Flow<N, H>& flow, const Workspace<N, H>& w) {
  return flow.at_rest(flow.mode(w.mode)) & flow.equations().holding;
}

// The modes in which each idle contact alone shares the forces again: its share is its stuck force there.
template <int N, int H>
void list_shares(Flow<N, H>& flow, Workspace<N, H>& w) {
  const ContactMask idle = at_rest(flow, w) & ~flow.mode(w.mode).stuck;
  w.sharing.resize(static_cast<std::size_t>(flow.equations().contacts()));
  for (Eigen::Index j = 0; idle != 0 && j < flow.equations().contacts(); ++j) {
    const Mode<N, H>& mode = flow.mode(w.mode);
    if (!contains(idle, j)) continue;
    w.sharing[static_cast<std::size_t>(j)] = flow.mode_index(mode.stuck | bit(j), mode.positive, mode.beyond);
  }
}

// Contact j starts from rest at w.left: the first nonzero coefficient of its sliding speed, by its power of
// time and its sign.
struct FirstMotion {
  int power = 1;
  double sign = 1.0;
};
template <int N, int H>
FirstMotion first_motion(const Flow<N, H>& flow, Eigen::Index j, Workspace<N, H>& w) {
  const Mode<N, H>& mode = flow.mode(w.mode);
  flow.accelerate(mode, w.left);
  Expansion<N, H> x;
  flow.expand(w.left, mode, x);
  Polynomial speed = x.velocity(flow.equations().W.col(j));
  speed.noalias() += x.u * flow.equations().support_velocity.row(j).transpose();
  FirstMotion first;
  while (first.power < 3 && std::abs(speed[first.power]) <= kRest * w.speed_scale[j]) ++first.power;
  first.sign = speed[first.power] < 0.0 ? -1.0 : 1.0;
  return first;
}

// Contact j starts to slide from rest.
template <int N, int H>
void start_sliding(Eigen::Index j, FirstMotion first, Workspace<N, H>& w) {
  w.fresh |= bit(j);
  if (first.power > 1) w.just_released |= bit(j);
}

// These contacts at rest, which all stick in w.mode, share the forces; those at their bounds are idle.
template <int N, int H>
void share(Flow<N, H>& flow, const RestProblem& rest, const LeastShares& shares, Workspace<N, H>& w) {
  ContactMask bound = 0, forward = 0;
  for (const Eigen::Index i : shares.bound) {
    bound |= rest.at(i);
    if (shares.lambda[i] > 0.0) forward |= rest.at(i);
  }
  const Mode<N, H> all = flow.mode(w.mode);
  while (bound != 0) {
    w.mode = flow.mode_index(all.stuck & ~bound, all.positive | (forward & bound), all.beyond);
    const ContactMask mobile = bound & ~flow.configuration(flow.mode(w.mode)).idle;
    if (mobile == 0) return;
    bound &= ~bit(first(mobile));  // the others do not hold it
  }
  w.mode = flow.mode_index(all.stuck, all.positive, all.beyond);
}

// Contacts at rest slide from now on, but for those that the others hold. Returns those that do.
template <int N, int H>
ContactMask slide(Flow<N, H>& flow, const RestOutcome& outcome, Workspace<N, H>& w) {
  const StepEquations<N, H>& eq = flow.equations();
  const Mode<N, H>& mode = flow.mode(w.mode);
  w.mode = flow.mode_index(mode.stuck & ~outcome.slides, (mode.positive & ~outcome.slides) | outcome.forward,
                           mode.beyond);
  const ContactMask slides = outcome.slides & ~at_rest(flow, w);
  w.fresh |= slides;
  w.just_released &= ~slides;
  for (Eigen::Index j = 0; outcome.is_slow && j < eq.contacts(); ++j) {
    if (contains(slides, j) && eq.static_limit[j] == eq.limit[j]) w.just_released |= bit(j);
  }
  return slides;
}

// Groups of these contacts at rest in which some force falls where it lets go, and which cannot all stay at
// rest, are chosen again. Returns the contacts that slide from now on.
template <int N, int H>
ContactMask slide_in_groups(Flow<N, H>& flow, const RestProblem& rest, ContactMask groups,
                            ContactMask cannot_stay, Workspace<N, H>& w) {
  const ContactMask contacts = flow.mode(w.mode).stuck & flow.equations().holding;
  const Eigen::VectorXd free = rest.G * rest.force;
  Choice choice{.stuck = contacts};
  ContactMask slid = 0;
  for (ContactMask open = groups & cannot_stay; open != 0;) {
    const ContactMask group = acting_together(flow.equations(), groups, first(open));
    open &= ~group;
    std::vector<Eigen::Index> entries;
    for (Eigen::Index i = 0; i < free.size(); ++i) {
      if ((rest.at(i) & group) != 0) entries.push_back(i);
    }
    choice.stuck &= ~group;
    choice = choice | choose_group(flow, group, rest.letting_go & group, free(entries), contacts, choice, w);
    slid |= group & ~choice.stuck;
  }
  start_chosen(flow, contacts, choice, w);
  return slid;
}

// The contacts at rest just after this instant: which slide, and how the others share the forces.
// letting_go: one whose force has reached its limit here (0: none). Returns those that begin to slide.
template <int N, int H>
ContactMask hold_together(Flow<N, H>& flow, ContactMask letting_go, Workspace<N, H>& w) {
  ContactMask slid = 0, before = 0;
  for (;;) {
    const ContactMask contacts = at_rest(flow, w);
    // None: all slide. As before: those chosen to slide are held by others, and carry their sliding force.
    if (contacts == 0 || contacts == before) return slid;
    before = contacts;
    const Mode<N, H>& mode = flow.mode(w.mode);
    w.mode = flow.mode_index(mode.stuck | contacts, mode.positive, mode.beyond);
    flow.accelerate(flow.mode(w.mode), w.left);
    RestProblem rest = rest_problem(flow, contacts, w);
    rest.letting_go = letting_go & contacts;
    const bool within = (rest.force.cwiseAbs().array() < (1.0 - kTie) * rest.bound.array()).all();
    if (within && rest.letting_go == 0) return slid;
    RestOutcome outcome = outcome_of(rest);
    if (!outcome.found) {
      w.undecided = kNotFound;
      return slid;
    }
    const std::size_t all = w.mode;
    const ContactMask groups = in_falling_groups(flow.equations(), contacts);
    ContactMask slides = 0;
    if ((outcome.slides & groups) != 0) {
      slides = slide_in_groups(flow, rest, groups, outcome.slides, w);
      letting_go &= ~groups;
      outcome.slides &= ~groups;
      outcome.forward &= ~groups;
    }
    if (outcome.slides != 0) slides |= slide(flow, outcome, w);
    if (slides == 0) {
      w.mode = all;
      share(flow, rest, outcome.shares, w);
      return slid;
    }
    slid |= slides;
  }
}

// A contact that was held at rest lets go. Contacts next to it whose internal force is at its limit continue
// to slide with it if they move in that direction.
template <int N, int H>
void slide_on(Flow<N, H>& flow, Workspace<N, H>& w) {
  if constexpr (Sizes<N, H>::kInternal != 0) {
    const StepEquations<N, H>& eq = flow.equations();
    for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
      const Mode<N, H>& mode = flow.mode(w.mode);
      if (eq.holds(j) || !contains(mode.stuck, j) || eq.limit[j] == 0.0) continue;
      const double force = w.left.z[2 * eq.masses() + eq.internal_of[static_cast<std::size_t>(j)]];
      if (std::abs(force) < eq.limit[j] * (1.0 - kTie)) continue;
      if (std::abs(flow.sliding_speed(w.left, j).value) > w.rest_speed[j]) continue;
      const FirstMotion first = first_motion(flow, j, w);
      if (first.sign * force < 0.0) continue;
      const ContactMask forward = force > 0.0 ? bit(j) : 0;
      w.mode = flow.mode_index(mode.stuck & ~bit(j), mode.positive | forward, mode.beyond);
      start_sliding(j, first, w);
    }
  }
}

}  // namespace frahm::periodic
