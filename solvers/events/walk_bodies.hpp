#pragma once

#include "solvers/events/bend_guards.hpp"
#include "solvers/events/saltation.hpp"
#include "solvers/events/search.hpp"
#include "solvers/events/transition.hpp"
#include "solvers/events/walk.hpp"
#include "solvers/events/walk_tangent.hpp"

// Bodies of Walk, for the files that instantiate it (walk_1_1.cpp and so on).
namespace frahm::periodic {

template <int N, int H>
void Walk<N, H>::pass(const typename S::State& z, double phase, double length, Passage<N, H>& passage,
                      Tangent tangent, ContactMask held, PassageSteps<N, H>* steps) {
  passage.has_path = flow_.equations().is_large() && tangent != Tangent::none;
  passage.has_tangent = tangent == Tangent::followed;
  w_.held = held;
  w_.left.z = z;
  open(phase, passage, steps);
  enter(phase);
  begin(passage);
  follow(phase, length, passage);
}

template <int N, int H>
void Walk<N, H>::go_on(double phase, double length, Passage<N, H>& passage, PassageSteps<N, H>* steps) {
  passage.has_path = passage.has_tangent = false;
  w_.held = 0;
  open(phase, passage, steps);
  if (!keeps_mode(phase)) enter(phase, flow_.at_rest(flow_.mode(w_.mode)));
  begin(passage);
  follow(phase, length, passage);
}

template <int N, int H>
void Walk<N, H>::follow(double phase, double length, Passage<N, H>& passage) {
  constexpr int kMostEvents = 20000;
  int at_this_instant = 0;
  SearchWork& work = flow_.work();
  while (passage.failure == nullptr) {
    work.add(flow_.step_work());
    if (work.is_over()) {
      passage.failure = kSearchIsLong;
      break;
    }
    w_.expanded = flow_.step(w_.left, flow_.mode(w_.mode), w_.right, w_.expansion);
    GuardEvent event = first_event(flow_, w_);
    BendEvent bend = first_bend(flow_, w_);
    if (is_here(event.at)) event.at = 0.0;
    if (is_here(bend.at)) bend.at = 0.0;
    const double next = std::min(event.at, bend.at), room = length - w_.clock;
    if (next < room && next <= 1.0) {
      w_.knows_left = false;
      work.add(flow_.event_work());
      at_this_instant = next > 0.0 ? 0 : at_this_instant + 1;
      if (bend.at < event.at)
        pass_bend(bend, phase, passage);
      else if (event.shares)
        pass_share(event, phase, passage);
      else
        pass_event(event, phase, passage);
      if (at_this_instant > 8 + 4 * (flow_.equations().contacts() + flow_.equations().bends.count()))
        passage.failure = "the contacts chatter at one instant";
      if (passage.events > kMostEvents) passage.failure = "more than 20000 events in one passage";
      if (w_.undecided != nullptr) passage.failure = w_.undecided;
    } else if (room <= 1.0) {
      if (room == 1.0)
        take_step(passage);
      else
        advance(room, phase, passage);
      end_stretch(passage);
      if (steps_ != nullptr) steps_->end_segment();
      passage.segments.back().length = length - passage.segments.back().start;
      break;
    } else {
      at_this_instant = 0;
      take_step(passage);
    }
  }
  passage.end = w_.left.z;
  passage.margin = w_.margin;
  if (!passage.end.allFinite()) passage.failure = "the state is not finite";
  if (passage.has_tangent && passage.has_path)
    flow_.tangent_along(passage.path, Precision::exact, passage.tangent);
}

template <int N, int H>
void Walk<N, H>::take_step(Passage<N, H>& passage) {
  move_tangent(1.0, passage);
  if (PassageStep<N, H>* step = keep_step(1.0)) step->right = w_.right;
  w_.left = w_.right;
  std::swap(w_.left_guard, w_.right_guard);
  w_.knows_left = true;
  w_.clock += 1.0;
  w_.leave_event();
}

// The step that begins at `left`, where steps are kept; its right end is the caller's.
template <int N, int H>
PassageStep<N, H>* Walk<N, H>::keep_step(double length) {
  if (steps_ == nullptr) return nullptr;
  PassageStep<N, H>& step = steps_->add();
  step.start = w_.clock;
  step.length = length;
  step.mode = w_.mode;
  step.left = w_.left;
  if (w_.expanded) std::swap(step.expansion, w_.expansion);
  step.expanded = w_.expanded;
  w_.expanded = false;
  return &step;
}

template <int N, int H>
void Walk<N, H>::open_segment(Passage<N, H>& passage) {
  if (steps_ != nullptr) steps_->end_segment();
  passage.segments.push_back({w_.clock, 0.0, w_.mode, w_.left.z});
  if (flow_.configuration(flow_.mode(w_.mode)).idle != 0) list_shares(flow_, w_);
}

template <int N, int H>
void Walk<N, H>::open(double phase, Passage<N, H>& passage, PassageSteps<N, H>* steps) {
  passage.segments.clear();
  passage.changes.clear();
  passage.events = passage.bends = 0;
  passage.failure = nullptr;
  steps_ = steps;
  if (steps_ != nullptr) steps_->clear();
  w_.clock = 0.0;
  w_.margin = 1.0;
  w_.undecided = nullptr;
  w_.behind = 0.0;
  w_.knows_left = false;
  passage.energy_scale = flow_.energy_scale(w_.left.z, phase);
  set_scales(flow_, passage.energy_scale, w_);
}

template <int N, int H>
void Walk<N, H>::begin(Passage<N, H>& passage) {
  if (w_.undecided != nullptr) passage.failure = w_.undecided;
  passage.starts_at_event = (w_.fresh | w_.at_place) != 0;
  begin_tangent(passage);
  open_segment(passage);
}

// Whether the last mode goes on at this phase: all that slide do so, and all that stick are within their
// limits. `left` is then seen from inside it.
template <int N, int H>
bool Walk<N, H>::keeps_mode(double phase) {
  const StepEquations<N, H>& eq = flow_.equations();
  const Mode<N, H>& mode = flow_.mode(w_.mode);
  if (eq.bends.count() > 0 || flow_.configuration(mode).idle != 0) return false;
  flow_.instant_at(typename S::State(w_.left.z), phase, mode, w_.left);
  flow_.configuration(mode).hold(eq, w_.left.u, w_.left.z);
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (contains(mode.stuck, j)) {
      const double force = std::abs(flow_.stuck_force(w_.left, mode, j).value);
      if (force >= eq.static_limit[j] * (1.0 - kTie)) return false;
    } else if (mode.sign(j) * flow_.sliding_speed(w_.left, j).value <= w_.rest_speed[j]) {
      return false;
    }
  }
  w_.leave_event();
  return true;
}

// The mode at the start of a passage. stuck_before: contacts that stuck up to now.
template <int N, int H>
void Walk<N, H>::enter(double phase, ContactMask stuck_before) {
  const StepEquations<N, H>& eq = flow_.equations();
  w_.fresh = w_.just_released = 0;

  w_.mode = flow_.mode_index(0, 0, 0);
  flow_.instant_at(typename S::State(w_.left.z), phase, flow_.mode(w_.mode), w_.left);
  const ContactMask beyond = bends_at_start(flow_, w_);
  ContactMask at_rest = 0, positive = 0, stuck_states = 0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    const double speed = flow_.sliding_speed(w_.left, j).value;
    if (speed > 0.0) positive |= bit(j);
    if constexpr (S::kInternal != 0) {
      if (!eq.holds(j)) {
        if (!starts_at_limit(j, speed)) stuck_states |= bit(j);
        continue;
      }
    }
    if (std::abs(speed) <= w_.rest_speed[j]) at_rest |= bit(j);
  }
  const ContactMask stick_on = eq.monotone ? 0 : stuck_before & at_rest;
  w_.mode = flow_.mode_index(stuck_states | stick_on, positive & ~at_rest, beyond);
  if (at_rest != 0) choose_modes(flow_, at_rest, w_);
  settle_mode(flow_, 0, w_);
}

// Whether contact j, whose force is a state, starts sliding: its force is at the limit, in the direction of
// the velocity. A force beyond the limit, which a search may try, starts at the limit.
template <int N, int H>
bool Walk<N, H>::starts_at_limit(Eigen::Index j, double speed) {
  const StepEquations<N, H>& eq = flow_.equations();
  double& s = w_.left.z[2 * eq.masses() + eq.internal_of[static_cast<std::size_t>(j)]];
  const double limit = eq.limit[j];
  const bool at_limit = std::abs(s) >= limit * (1.0 - kTie);
  s = std::clamp(s, -limit, limit);
  if (limit == 0.0) return true;
  return at_limit && s * speed > 0.0 && std::abs(speed) > w_.rest_speed[j];
}

// `left` and the tangent `fraction` of a step later in the same mode; the oscillators of `left` are not
// moved.
template <int N, int H>
void Walk<N, H>::advance(double fraction, double phase, Passage<N, H>& passage) {
  typename S::State z;
  Flow<N, H>::evaluate(w_.expand(flow_), fraction, z);
  PassageStep<N, H>* const step = keep_step(fraction);
  w_.left.z = z;
  w_.clock += fraction;
  if (step != nullptr)
    flow_.instant_at(z, phase + w_.clock * flow_.fundamental_rate(), flow_.mode(w_.mode), step->right);
  move_tangent(fraction, passage);
}

// `left` and the tangent at an event, seen from inside the segment that it ends.
template <int N, int H>
void Walk<N, H>::arrive_at(double fraction, double phase, Passage<N, H>& passage) {
  if (fraction > 0.0) {
    advance(fraction, phase, passage);
    w_.leave_event();
  }
  end_stretch(passage);
  flow_.instant_at(typename S::State(w_.left.z), phase + w_.clock * flow_.fundamental_rate(),
                   flow_.mode(w_.mode), w_.left);
  passage.segments.back().length = w_.clock - passage.segments.back().start;
  ++passage.events;
}

template <int N, int H>
void Walk<N, H>::pass_event(const GuardEvent& event, double phase, Passage<N, H>& passage) {
  // 1. Move to the event.
  const std::size_t mode_before = w_.mode;
  arrive_at(event.at, phase, passage);
  const Instant<N, H> before = w_.left;

  // 2. What follows, of all contacts that are concerned together.
  const ContactMask arrived = arrivals(flow_, event.release ? -1 : event.contact, w_);
  bool forward = false;
  if (event.release) {
    const ValueAndSlope force = flow_.stuck_force(w_.left, flow_.mode(mode_before), event.contact);
    w_.note_margin(std::abs(force.slope) / w_.force_scale[event.contact]);
    forward = force.value > 0.0;
  }
  change_mode(flow_, arrived, event.release ? event.contact : -1, forward, w_);

  // 3. Carry the tangent across.
  const ContactMask released = flow_.mode(mode_before).stuck & ~flow_.mode(w_.mode).stuck;
  note_arrivals(flow_, arrived, before, w_);
  if (passage.has_path || passage.has_tangent) {
    const ContactMask let_go = event.release ? bit(event.contact) : 0;
    add_contacts(flow_, arrived, let_go, before, flow_.mode(mode_before), w_);
    saltate(released, passage);
    catch_contacts(arrived, flow_.mode(mode_before), passage);
  }

  // 4. Record the change and begin the next segment.
  note_change(event, flow_.mode(mode_before), passage);
  open_segment(passage);
}

// An idle contact shares the forces again: the motion goes on unchanged.
template <int N, int H>
void Walk<N, H>::pass_share(const GuardEvent& event, double phase, Passage<N, H>& passage) {
  arrive_at(event.at, phase, passage);
  --passage.events;
  const double side = flow_.mode(w_.mode).sign(event.contact);
  w_.mode = w_.sharing[static_cast<std::size_t>(event.contact)];
  flow_.accelerate(flow_.mode(w_.mode), w_.left);
  if (Event* change = change_here(passage)) {
    change->shares = event.contact;
    change->side = side;
  }
  open_segment(passage);
}

// An element bends. Where its force jumps, the forces of all contacts at rest are chosen again.
template <int N, int H>
void Walk<N, H>::pass_bend(const BendEvent& event, double phase, Passage<N, H>& passage) {
  const std::size_t mode_before = w_.mode;
  arrive_at(event.at, phase, passage);
  const Instant<N, H> before = w_.left;
  ++passage.bends;
  const double slope = bend_guard(flow_, before, event.guard, event.bend).slope;
  change_bend(flow_, event, w_);
  const bool bends = w_.mode != mode_before;
  const bool jumps =
      bends && event.guard == BendGuard::place && contains(flow_.equations().bends.jumping, event.bend);
  if (bends) {
    const ContactMask resting = at_rest(flow_, w_);
    if (jumps && resting != 0) choose_modes(flow_, resting, w_);
    settle_mode(flow_, 0, w_);
  }
  if (jumps && (passage.has_path || passage.has_tangent)) {
    add_bend(flow_, event.bend, before, slope, w_);
    saltate(0, passage);
    catch_contacts(0, flow_.mode(mode_before), passage);
  }
  if (Event* change = change_here(passage)) {
    change->released |= flow_.mode(mode_before).stuck & ~flow_.mode(w_.mode).stuck;
    if (bends) (event.guard == BendGuard::place ? change->at_place : change->by_force) |= bit(event.bend);
  }
  open_segment(passage);
}

// The record of the change that ends the current segment, of which all events at one instant are one; null at
// the very start.
template <int N, int H>
Event* Walk<N, H>::change_here(Passage<N, H>& passage) const {
  const bool same_instant = passage.segments.back().length == 0.0;
  if (same_instant) passage.segments.pop_back();
  if (passage.segments.empty()) return nullptr;
  if (!same_instant) passage.changes.push_back({.segment = passage.segments.size() - 1});
  return &passage.changes.back();
}

template <int N, int H>
void Walk<N, H>::note_change(const GuardEvent& event, const Mode<N, H>& mode_before,
                             Passage<N, H>& passage) const {
  Event* change = change_here(passage);
  if (change == nullptr) return;
  const Mode<N, H>& after = flow_.mode(w_.mode);
  change->arrived |= arrived_between(flow_, mode_before, after);
  change->released |= mode_before.stuck & ~after.stuck;
  if (event.release) change->let_go |= bit(event.contact);
}

}  // namespace frahm::periodic
