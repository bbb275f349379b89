#pragma once

#include <utility>
#include <vector>

#include "solvers/events/admissible.hpp"
#include "solvers/events/rest_problem.hpp"
#include "solvers/events/workspace.hpp"

// Contacts at rest that hold more than they do sliding (F_s > F), and those whose forces act on theirs, are
// chosen together (admissible.hpp).
namespace frahm::periodic {

// The choice for contacts at rest.
struct Choice {
  ContactMask stuck = 0, forward = 0;
  ContactMask at_limit = 0;  // of several, that stick with a force at its limit
  ContactMask slow = 0;      // that slide, their acceleration still zero
};

inline Choice operator|(const Choice& a, const Choice& b) {
  return {a.stuck | b.stuck, a.forward | b.forward, a.at_limit | b.at_limit, a.slow | b.slow};
}

inline constexpr const char* kNoneAdmissible =
    "contacts at rest together can neither stick nor slide as their static_force and force demand";

// The contacts of `among` whose forces act on that of contact j, by steps from one to the next; j too.
template <int N, int H>
ContactMask acting_together(const StepEquations<N, H>& eq, ContactMask among, Eigen::Index j) {
  constexpr double kNone = 1e-13;
  ContactMask group = bit(j);
  for (ContactMask open = group; open != 0;) {
    const Eigen::Index i = first(open);
    open &= ~bit(i);
    for (ContactMask others = among & ~group; others != 0; others &= others - 1) {
      const Eigen::Index k = first(others);
      if (std::abs(eq.mobility(i, k)) <= kNone * std::sqrt(eq.compliance[i] * eq.compliance[k])) continue;
      group |= bit(k);
      open |= bit(k);
    }
  }
  return group;
}

template <int N, int H>
bool some_fall(const StepEquations<N, H>& eq, ContactMask contacts) {
  for (; contacts != 0; contacts &= contacts - 1) {
    if (eq.static_limit[first(contacts)] != eq.limit[first(contacts)]) return true;
  }
  return false;
}

// For contacts at rest those with friction that act together with one whose force falls where it lets go.
template <int N, int H>
ContactMask in_falling_groups(const StepEquations<N, H>& eq, ContactMask at_rest) {
  ContactMask found = 0;
  if (eq.monotone) return found;
  ContactMask open = 0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (contains(at_rest, j) && eq.limit[j] > 0.0) open |= bit(j);
  }
  while (open != 0) {
    const ContactMask group = acting_together(eq, open, first(open));
    if (some_fall(eq, group)) found |= group;
    open &= ~group;
  }
  return found;
}

// The contacts at rest at w.left, which all stick in w.mode.
template <int N, int H>
RestProblem rest_problem(const Flow<N, H>& flow, ContactMask contacts, const Workspace<N, H>& w) {
  constexpr double kWithoutBound = 1e9;
  const StepEquations<N, H>& eq = flow.equations();
  RestProblem rest;
  rest.contacts = list_of(contacts);
  const auto m = static_cast<Eigen::Index>(rest.contacts.size());
  rest.W = eq.W(Eigen::all, rest.contacts);
  rest.G = eq.mobility(rest.contacts, rest.contacts);
  rest.weight = eq.limit(rest.contacts);
  rest.bound = eq.static_limit(rest.contacts);
  rest.force.resize(m);
  rest.rate.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index j = rest.contacts[static_cast<std::size_t>(i)];
    if (contains(w.held, j)) rest.bound[i] = kWithoutBound * rest.weight[i];
    const ValueAndSlope force = flow.stuck_force(w.left, flow.mode(w.mode), j);
    rest.force[i] = force.value;
    rest.rate[i] = force.slope;
  }
  return rest;
}

inline constexpr const char* kNotFound = "the friction forces of contacts at rest were not found";

// The mode in which contacts at rest do what is chosen for them.
template <int N, int H>
std::size_t chosen_mode(Flow<N, H>& flow, ContactMask at_rest, const Choice& choice,
                        const Workspace<N, H>& w) {
  const Mode<N, H>& before = flow.mode(w.mode);
  const ContactMask others = before.stuck & ~at_rest;
  return flow.mode_index(choice.stuck | others, (before.positive & ~at_rest) | choice.forward, before.beyond);
}

// Contacts at rest do from now on what is chosen for them.
template <int N, int H>
void start_chosen(Flow<N, H>& flow, ContactMask at_rest, const Choice& choice, Workspace<N, H>& w) {
  const ContactMask sliding = at_rest & ~choice.stuck;
  w.fresh |= sliding;
  w.just_released = (w.just_released & ~sliding) | choice.slow;
  w.mode = chosen_mode(flow, at_rest, choice, w);
}

// For these contacts, which stick with forces at their limits or slide without acceleration in this mode,
// those that do otherwise just after this instant. letting_go: one of a loop, whose force has reached its
// limit. Cold, as what follows: few events come here, and it stays out of the code of all others.
template <int N, int H>
[[gnu::cold]] ContactMask broken_claims(Flow<N, H>& flow, std::size_t index, ContactMask contacts,
                                        ContactMask letting_go, Workspace<N, H>& w) {
  const StepEquations<N, H>& eq = flow.equations();
  const Mode<N, H>& mode = flow.mode(index);
  Instant<N, H> at = w.left;
  flow.accelerate(mode, at);
  Expansion<N, H> x;
  flow.expand(at, mode, x);
  ContactMask broken = 0;
  const auto first_term = [](const Polynomial& p, double little) {
    int k = 1;
    while (k < 4 && std::abs(p[k]) <= little) ++k;
    return k < 4 ? p[k] : 0.0;
  };
  const ContactMask in_doubt = eq.has_loops ? contacts & ~mode.stuck : contacts;
  for (const Eigen::Index j : list_of(in_doubt)) {
    if (contains(mode.stuck, j)) {
      const Polynomial force = flow.stuck_force(x, mode, j);
      const double growth = first_term(force, kTie * eq.static_limit[j]);
      if (growth * force[0] > 0.0) broken |= bit(j);
    } else {
      Polynomial speed = x.velocity(eq.W.col(j));
      speed.noalias() += x.u * eq.support_velocity.row(j).transpose();
      if (mode.sign(j) * first_term(speed, kRest * w.speed_scale[j]) <= 0.0) broken |= bit(j);
    }
  }
  if ((contacts & mode.stuck) != 0 && eq.has_loops) {
    const std::size_t mode_now = std::exchange(w.mode, index);
    flow.accelerate(flow.mode(index), w.left);
    RestProblem rest = rest_problem(flow, mode.stuck & eq.holding, w);
    rest.letting_go = letting_go & mode.stuck;
    const RestOutcome outcome = outcome_of(rest);
    broken |= outcome.found ? outcome.slides : contacts;
    w.mode = mode_now;
  }
  return broken;
}

// The choice for a group of contacts at rest, of relative accelerations `free` if the group had no friction.
// letting_go: of them one whose force has reached its limit here. others: the choice for the other contacts
// of at_rest.
template <int N, int H>
[[gnu::cold]] Choice choose_group(Flow<N, H>& flow, ContactMask group, ContactMask letting_go,
                                  const Eigen::VectorXd& free, ContactMask at_rest, const Choice& others,
                                  Workspace<N, H>& w) {
  const StepEquations<N, H>& eq = flow.equations();
  const std::vector<Eigen::Index> contacts = list_of(group);
  const auto m = static_cast<Eigen::Index>(contacts.size());
  const auto contact = [&](Eigen::Index i) { return contacts[static_cast<std::size_t>(i)]; };
  const auto entries_of = [&](ContactMask mask) {
    ContactMask entries = 0;
    for (Eigen::Index i = 0; i < m; ++i) entries |= contains(mask, contact(i)) ? bit(i) : 0;
    return entries;
  };
  const auto contacts_of = [&](ContactMask entries) {
    ContactMask mask = 0;
    for (const Eigen::Index i : list_of(entries)) mask |= bit(contact(i));
    return mask;
  };
  const ContactsAtRest rest{.G = eq.mobility(contacts, contacts),
                            .free = free,
                            .kinetic = eq.limit(contacts),
                            .limit = eq.static_limit(contacts),
                            .has_loops = eq.has_loops,
                            .held = entries_of(w.held),
                            .stuck_before = entries_of(flow.at_rest(flow.mode(w.mode))),
                            .letting_go = entries_of(letting_go)};
  const auto choice_of = [&](const RestChoice& of) {
    return Choice{.stuck = contacts_of(of.stuck),
                  .forward = contacts_of(of.forward),
                  .at_limit = contacts_of(of.on_edge & of.stuck),
                  .slow = contacts_of(of.on_edge & ~of.stuck)};
  };
  const auto broken = [&](const RestChoice& of) {
    const std::size_t mode = chosen_mode(flow, at_rest, choice_of(of) | others, w);
    const ContactMask lets_go = of.stuck == entries_of(group) ? letting_go : 0;  // else its force has changed
    return entries_of(broken_claims(flow, mode, contacts_of(of.on_edge), lets_go, w));
  };
  const RestChoice chosen = admissible_choice(rest, broken);
  flow.work().add(chosen.trials * flow.event_work());
  if (!chosen.found) w.undecided = kNoneAdmissible;
  w.note_margin(chosen.margin);
  w.settled |= group;
  return choice_of(chosen);
}

}  // namespace frahm::periodic
