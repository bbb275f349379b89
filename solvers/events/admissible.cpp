#include "solvers/events/admissible.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "solvers/events/box_minimum.hpp"
#include "solvers/events/tolerances.hpp"
#include "solvers/flow/constraints.hpp"

namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Relative tolerances: within kEdge of its limit a force is at it, as in search.hpp; one that has reached its
// limit by an event is at it within kAtLimit.
constexpr double kEdge = 4.0 * kTie, kAtLimit = 1e-9;
constexpr double kSumRounding = 16.0 * std::numeric_limits<double>::epsilon();
constexpr double kSameSum = 1e-9;  // relative: sums that a symmetry makes equal
constexpr double kMostTrials = 6561.0;

// A set of contacts that stick, and what their forces follow from.
struct Held {
  ContactMask stuck = 0;
  std::vector<Index> sticking, sliding;
  MatrixXd inverse;       // G^+ over those that stick
  ContactMask loops = 0;  // those of them that others of them could hold
};

struct Trial {
  RestChoice choice;
  double violation = 0.0;  // of the claim that is worst broken; 0: none is
  Index worst = -1;        // the contact that breaks it
  bool lets_go = false;    // a contact would stick that lets go here
  Index kept = 0;          // of what stuck before
  double sum = 0.0;        // of (lambda / F_s)^2
};

class Search {
 public:
  Search(const ContactsAtRest& rest, const BrokenClaims& broken)
      : rest_(rest), broken_(broken), m_(rest.free.size()) {
    narrow();
  }

  RestChoice choice() {
    if (ways() <= kMostTrials)
      try_all();
    else
      follow_active_set();
    best_.choice.margin = std::min(best_.choice.margin, margin_);
    best_.choice.trials = trials_;
    return best_.choice;
  }

 private:
  struct Ways {
    bool sticks = true, forward = true, backward = true;
    int count() const { return (sticks ? 1 : 0) + (forward ? 1 : 0) + (backward ? 1 : 0); }
  };

  double size(Index i) const { return rest_.G(i, i) * rest_.kinetic[i] + std::abs(rest_.free[i]); }
  ContactMask all() const { return m_ >= kMostContacts ? ~ContactMask{0} : bit(m_) - 1; }
  void narrow();
  std::array<double, 2> force_range(Index i) const;
  double ways() const;
  void try_all();
  void try_sets(const std::vector<Index>& open, std::size_t from, Index more, ContactMask slides);
  void try_directions(ContactMask slides);
  void follow_active_set();
  Held hold(ContactMask stuck) const;
  VectorXd held_forces(const Held& held, const VectorXd& needed) const;
  Trial trial(const Held& held, ContactMask forward);
  void check_stuck(const Held& held, Index i, Trial& trial) const;
  void check_sliding(Index i, Trial& trial) const;
  void consider(Trial trial);
  void take_kinetic();
  void take(Trial trial) {
    best_ = std::move(trial);
    best_.choice.found = true;
  }
  void note_margin(double relative) { margin_ = std::min(margin_, relative); }

  const ContactsAtRest& rest_;
  const BrokenClaims& broken_;
  Index m_;
  std::vector<Ways> ways_;
  Trial best_;
  double margin_ = 1.0;
  int trials_ = 0;
};

// The forces that are left to contact i.
std::array<double, 2> Search::force_range(Index i) const {
  const Ways& ways = ways_[static_cast<std::size_t>(i)];
  if (ways.sticks && contains(rest_.held, i)) return {-HUGE_VAL, HUGE_VAL};
  if (ways.sticks) return {-rest_.limit[i], rest_.limit[i]};
  return {ways.backward ? -rest_.kinetic[i] : rest_.kinetic[i],
          ways.forward ? rest_.kinetic[i] : -rest_.kinetic[i]};
}

// Leaves out ways that no forces of the others allow: what pulls at a contact is c_i - sum_k G_ik lambda_k.
void Search::narrow() {
  ways_.assign(static_cast<std::size_t>(m_), {});
  for (const Index i : list_of(rest_.held & all())) ways_[static_cast<std::size_t>(i)] = {true, false, false};
  for (bool again = true; again;) {
    again = false;
    for (Index i = 0; i < m_; ++i) {
      if (contains(rest_.held, i)) continue;
      double least = rest_.free[i], most = least;
      for (Index k = 0; k < m_; ++k) {
        const double by = rest_.G(i, k);
        if (k == i || by == 0.0) continue;
        const auto [low, high] = force_range(k);
        least -= by * (by > 0.0 ? high : low);
        most -= by * (by > 0.0 ? low : high);
      }
      const double g = rest_.G(i, i), room = 1e-6 * size(i);
      const Ways before = ways_[static_cast<std::size_t>(i)];
      Ways& ways = ways_[static_cast<std::size_t>(i)];
      ways.sticks = before.sticks && least <= g * rest_.limit[i] + room && most >= -g * rest_.limit[i] - room;
      ways.forward = before.forward && most - g * rest_.kinetic[i] >= -room;
      ways.backward = before.backward && least + g * rest_.kinetic[i] <= room;
      again = again || ways.count() != before.count();
    }
  }
}

double Search::ways() const {
  double count = 1.0;
  for (const Ways& ways : ways_) count *= ways.count();
  return count;
}

void Search::try_all() {
  ContactMask slides = 0;
  std::vector<Index> open;  // that may stick and may slide
  for (Index i = 0; i < m_; ++i) {
    const Ways& ways = ways_[static_cast<std::size_t>(i)];
    if (!ways.sticks)
      slides |= bit(i);
    else if (ways.forward || ways.backward)
      open.push_back(i);
  }
  for (Index more = 0; more <= static_cast<Index>(open.size()) && !best_.choice.found; ++more)
    try_sets(open, 0, more, slides);
}

// All sets in which `more` of those from this place on slide too.
void Search::try_sets(const std::vector<Index>& open, std::size_t from, Index more, ContactMask slides) {
  if (more == 0) return try_directions(slides);
  for (std::size_t i = from; i + static_cast<std::size_t>(more) <= open.size(); ++i)
    try_sets(open, i + 1, more - 1, slides | bit(open[i]));
}

void Search::try_directions(ContactMask slides) {
  ContactMask forward = 0;
  std::vector<Index> either;
  for (const Index i : list_of(slides)) {
    const Ways& ways = ways_[static_cast<std::size_t>(i)];
    if (!ways.forward && !ways.backward) return;
    if (ways.forward && ways.backward)
      either.push_back(i);
    else if (ways.forward)
      forward |= bit(i);
  }
  const Held held = hold(all() & ~slides);
  for (ContactMask code = 0; code < bit(static_cast<Index>(either.size())); ++code) {
    ContactMask chosen = forward;
    for (const Index i : list_of(code)) chosen |= bit(either[static_cast<std::size_t>(i)]);
    consider(trial(held, chosen));
  }
}

Held Search::hold(ContactMask stuck) const {
  Held held;
  held.stuck = stuck;
  held.sticking = list_of(stuck);
  held.sliding = list_of(all() & ~stuck);
  if (held.sticking.empty()) return held;
  const MatrixXd G = rest_.G(held.sticking, held.sticking);
  if (!rest_.has_loops) {
    held.inverse = inverse_of(G);
    return held;
  }
  held.inverse = weighted_pseudo_inverse(G, rest_.limit(held.sticking));
  const MatrixXd share = held.inverse * G;
  for (std::size_t i = 0; i < held.sticking.size(); ++i) {
    const auto place = static_cast<Index>(i);
    if (share(place, place) < 1.0 - 1e-6) held.loops |= bit(held.sticking[i]);
  }
  return held;
}

// The forces of those that stick: G lambda = needed. In a loop those of least sum (lambda / F_s)^2, within
// the limits where there are any.
VectorXd Search::held_forces(const Held& held, const VectorXd& needed) const {
  const MatrixXd G = rest_.G(held.sticking, held.sticking);
  VectorXd lambda = held.inverse * needed;
  lambda += held.inverse * (needed - G * lambda);
  if (held.loops == 0) return lambda;
  constexpr double kWithoutLimit = 1e9;
  const VectorXd weight = rest_.limit(held.sticking);
  VectorXd limit = weight;
  for (std::size_t i = 0; i < held.sticking.size(); ++i) {
    if (contains(rest_.held, held.sticking[i])) limit[static_cast<Index>(i)] *= kWithoutLimit;
  }
  if ((lambda.cwiseAbs().array() <= limit.array()).all()) return lambda;
  return box_minimum(G, needed, -limit, limit, weight).lambda;
}

Trial Search::trial(const Held& held, ContactMask forward) {
  ++trials_;
  Trial result;
  RestChoice& choice = result.choice;
  choice.stuck = held.stuck;
  choice.forward = forward;
  choice.force.setZero(m_);
  for (const Index i : held.sliding)
    choice.force[i] = contains(forward, i) ? rest_.kinetic[i] : -rest_.kinetic[i];
  if (!held.sticking.empty()) {
    const VectorXd needed = (rest_.free - rest_.G * choice.force)(held.sticking);
    choice.force(held.sticking) = held_forces(held, needed);
  }
  choice.acceleration = rest_.free - rest_.G * choice.force;
  for (const Index i : held.sticking) check_stuck(held, i, result);
  for (const Index i : held.sliding) check_sliding(i, result);
  const ContactMask lets_go = rest_.letting_go & held.stuck;
  const bool nothing_changes = held.stuck == all() && rest_.stuck_before == all();
  if (nothing_changes) choice.on_edge |= lets_go & held.loops;  // the others may hold it
  if (nothing_changes && (lets_go & ~held.loops) != 0) result.lets_go = true;
  result.kept = count(held.stuck & rest_.stuck_before);
  result.sum = choice.force.cwiseQuotient(rest_.limit).squaredNorm();
  return result;
}

void Search::check_stuck(const Held& held, Index i, Trial& trial) const {
  constexpr double kLoopRounding = 1e-9;  // as of rest_problem.cpp
  RestChoice& choice = trial.choice;
  const auto breaks = [&](double by) {
    if (by <= trial.violation) return;
    trial.violation = by;
    trial.worst = i;
  };
  const double terms = rest_.G.row(i).cwiseAbs().dot(choice.force.cwiseAbs()) + std::abs(rest_.free[i]);
  if (contains(held.loops, i)) {
    const double pull = std::abs(choice.acceleration[i]);
    if (pull > kLoopRounding * terms + kTie * rest_.G(i, i) * rest_.kinetic[i]) breaks(pull / size(i));
  }
  if (contains(rest_.held, i)) return;
  const double tie = kEdge + kSumRounding * terms / (rest_.G(i, i) * rest_.limit[i]);
  const double force = std::abs(choice.force[i]) / rest_.limit[i], room = 1.0 - force;
  if (room < -tie)
    breaks(-room);
  else if (room <= tie)
    choice.on_edge |= bit(i);
  else
    choice.margin = std::min(choice.margin, room);
  if (!contains(rest_.letting_go, i) || force < 1.0 - kAtLimit) return;
  if (contains(held.loops, i)) {
    choice.on_edge |= bit(i);
  } else {
    trial.lets_go = true;
    trial.worst = i;
  }
}

void Search::check_sliding(Index i, Trial& trial) const {
  RestChoice& choice = trial.choice;
  const double side = contains(choice.forward, i) ? 1.0 : -1.0;
  const double pull = side * choice.acceleration[i] / size(i);
  const double rounding = kSumRounding * rest_.G.row(i).cwiseAbs().dot(choice.force.cwiseAbs()) / size(i);
  const double tie = std::max(kTie, rounding);
  if (pull < -tie) {
    if (-pull <= trial.violation) return;
    trial.violation = -pull;
    trial.worst = i;
  } else if (pull <= tie) {
    choice.on_edge |= bit(i);
  } else {
    choice.margin = std::min(choice.margin, pull);
  }
}

// Takes a trial if it is admissible and preferable to the best so far. How far one is from being so is a
// margin, unless it is the event itself that forbids it.
void Search::consider(Trial trial) {
  if (trial.lets_go) return;
  if (trial.violation > 0.0) return note_margin(trial.violation);
  if (best_.choice.found) {
    const double difference = trial.sum - best_.sum, equal = kSameSum * best_.sum;
    if (trial.kept < best_.kept) return;
    if (trial.kept == best_.kept && difference >= -equal) return note_margin(std::max(difference, 0.0));
  }
  if (trial.choice.on_edge != 0 && broken_(trial.choice) != 0) {
    if ((trial.choice.on_edge & ~rest_.letting_go) != 0) note_margin(0.0);
    return;
  }
  take(std::move(trial));
}

// From all sticking: the contact that breaks its claim worst takes another way, until none does.
void Search::follow_active_set() {
  ContactMask stuck = 0, forward = 0;
  for (Index i = 0; i < m_; ++i) {
    const Ways& ways = ways_[static_cast<std::size_t>(i)];
    if (ways.sticks)
      stuck |= bit(i);
    else if (ways.forward)
      forward |= bit(i);
  }
  std::set<std::pair<ContactMask, ContactMask>> seen;
  while (seen.insert({stuck, forward}).second) {
    Trial next = trial(hold(stuck), forward);
    Index change = next.worst;
    if (next.violation == 0.0 && !next.lets_go) {
      const ContactMask broken = next.choice.on_edge != 0 ? broken_(next.choice) : 0;
      if (broken == 0) return take(std::move(next));
      change = first(broken);
    }
    if (change < 0) change = first(rest_.letting_go);
    const bool sticks = contains(stuck, change);
    const bool in_loop = std::abs(next.choice.acceleration[change]) > kAtLimit * size(change);
    const double side = in_loop ? next.choice.acceleration[change] : next.choice.force[change];
    forward &= ~bit(change);
    if (sticks && side > 0.0) forward |= bit(change);
    stuck ^= bit(change);
  }
  take_kinetic();
}

// What would be chosen if none held more than F: of all choices the one that is always admissible.
void Search::take_kinetic() {
  constexpr double kWithoutLimit = 1e9;
  VectorXd most = rest_.kinetic;
  for (const Index i : list_of(rest_.held & all())) most[i] *= kWithoutLimit;
  const BoxMinimum minimum = box_minimum(rest_.G, rest_.free, -most, most, rest_.kinetic);
  if (!minimum.found) return;
  const VectorXd acceleration = rest_.free - rest_.G * minimum.lambda;
  ContactMask stuck = 0, forward = 0;
  for (Index i = 0; i < m_; ++i) {
    if (std::abs(acceleration[i]) <= kAtLimit * size(i))
      stuck |= bit(i);
    else if (acceleration[i] > 0.0)
      forward |= bit(i);
  }
  consider(trial(hold(stuck), forward));
}

}  // namespace

RestChoice admissible_choice(const ContactsAtRest& rest, const BrokenClaims& broken) {
  return Search(rest, broken).choice();
}

}  // namespace frahm::periodic
