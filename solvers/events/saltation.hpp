#pragma once

#include "solvers/events/coupled_groups.hpp"
#include "solvers/events/joint_choice.hpp"
#include "solvers/events/workspace.hpp"

namespace frahm::periodic {

// A contact that comes to rest slowly is close to another outcome.
template <int N, int H>
void note_arrivals(const Flow<N, H>& flow, ContactMask arrived, const Instant<N, H>& before,
                   Workspace<N, H>& w) {
  for (Eigen::Index j = 0; j < flow.equations().contacts(); ++j) {
    if (contains(arrived, j))
      w.note_margin(std::abs(flow.sliding_speed(before, j).slope) / (kStepRate * w.speed_scale[j]));
  }
}

// What an event does to small changes of the state, where a guard g(z, t) reaches zero with the slope g', the
// fields f before and after (Leine and Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems,
// 2004, ch. 7):
//   dz+ = dz- + (f+ - f-) (grad g dz-) / g'
// before: the event's instant seen from inside the mode before it; w.left: from inside the mode after. Each
// function adds its jumps to w.jumps.

// Whether the force of a contact falls where it lets go.
template <int N, int H>
bool falls_at_release(const StepEquations<N, H>& eq, Eigen::Index j) {
  return eq.holds(j) && eq.static_limit[j] != eq.limit[j];
}

// Whether the force of a stuck contact is at its static limit: it lets go by itself, not because of what else
// jumps at the instant.
template <int N, int H>
bool is_at_limit(const Flow<N, H>& flow, Eigen::Index j, const Instant<N, H>& at, const Mode<N, H>& mode) {
  return std::abs(flow.stuck_force(at, mode, j).value) >= flow.equations().static_limit[j] * (1.0 - kRest);
}

// For contacts that let go those at whose guards the acceleration jumps, because forces fall from static
// limits: `own`, whose event it is, and others that are at their limits at the same instant. The force of
// `own` itself may stay: what it releases may make others fall.
template <int N, int H>
ContactMask falling(const Flow<N, H>& flow, ContactMask own, const Instant<N, H>& before,
                    const Mode<N, H>& mode_before, const Mode<N, H>& mode) {
  const StepEquations<N, H>& eq = flow.equations();
  ContactMask result = 0;
  if (eq.monotone) return result;
  const ContactMask released = mode_before.stuck & ~flow.at_rest(mode) & eq.holding;
  for (ContactMask left = released | own; left != 0; left &= left - 1) {
    const Eigen::Index j = first(left);
    if (falls_at_release(eq, j) && (contains(own, j) || is_at_limit(flow, j, before, mode_before)))
      result |= bit(j);
  }
  return result == 0 && some_fall(eq, released) ? own : result;
}

// The jumps of contacts that reach their guards together:
//   a velocity that reaches zero  dv+ = dv- + (a+ - a-)(w^T dv-)/(w^T a- + p^T y''); exact for a reversal and
//                                 for a stop, where it is the M-orthogonal projection on what sticks
//   a force that falls            dv+ = dv- + (a+ - a-)(grad lambda dz-)/lambda'
// Nothing jumps for a contact whose force is a state, and for one whose force does not fall. Each group of
// those that feel one another (coupled_groups.hpp) has its own part of a+ - a-. Within a group each arrival
// adds what its own force takes up; the first of the group adds the rest, such as the share of stuck contacts
// that are released: that is exact where all of a group are shifted alike, and where they do not feel one
// another.
template <int N, int H>
void add_contacts(const Flow<N, H>& flow, ContactMask arrived, ContactMask let_go,
                  const Instant<N, H>& before, const Mode<N, H>& mode_before, Workspace<N, H>& w) {
  using S = Sizes<N, H>;
  const StepEquations<N, H>& eq = flow.equations();
  const Mode<N, H>& mode = flow.mode(w.mode);
  const ContactMask arrivals = arrived & eq.holding, falls = falling(flow, let_go, before, mode_before, mode);
  if ((arrivals | falls) == 0) return;
  const auto slope_of = [&](Eigen::Index j) {
    return contains(arrivals, j) ? flow.sliding_speed(before, j).slope
                                 : flow.stuck_force(before, mode_before, j).slope;
  };
  const auto add = [&](Eigen::Index j, double slope, const typename S::Vector& change) {
    if (contains(arrivals, j))
      w.jumps.push_back({.contact = static_cast<int>(j), .change = change / slope, .by = {}});
    else
      w.jumps.push_back(
          {.contact = -1, .change = change / slope, .by = flow.stuck_force_form(mode_before, j)});
  };
  // For its group's part, what the friction of arrival j takes up, with the contacts that stuck before.
  const auto share_of = [&](Eigen::Index j) {
    const double after = contains(mode.stuck, j) ? flow.stuck_force(w.left, mode, j).value : mode.friction[j];
    typename S::Contacts jump = S::Contacts::Zero(eq.contacts());
    jump[j] = after - mode_before.friction[j];
    return flow.configuration(mode_before).pull_of_friction(eq, jump);
  };
  const auto add_group = [&](ContactMask its, typename S::Vector left) {
    Eigen::Index leader = -1;
    double leader_slope = 0.0;
    for (; its != 0; its &= its - 1) {
      const Eigen::Index j = first(its);
      const double slope = slope_of(j);
      if (slope == 0.0) continue;
      if (leader < 0) {
        leader = j;
        leader_slope = slope;
      } else if (contains(arrivals, j)) {
        const typename S::Vector change = share_of(j);
        add(j, slope, change);
        left -= change;
      }
    }
    if (leader >= 0) add(leader, leader_slope, left);
  };
  if (count(arrivals | falls) == 1) return add_group(arrivals | falls, w.left.a - before.a);
  const ContactMask resting = (flow.at_rest(mode_before) | flow.at_rest(mode)) & eq.holding;
  const CoupledGroups<N, H> groups(eq, arrivals | falls | resting, 0);
  for (std::size_t g = 0; g < groups.count(); ++g)
    add_group(groups.contacts(g) & (arrivals | falls), groups.part(g, w.left.a - before.a));
}

// An element whose force jumps where it bends, at a place of the displacement that it passes at the speed
// `slope`:  dv+ = dv- + (a+ - a-) (b^T dq-) / (b^T v + p^T y')
template <int N, int H>
void add_bend(const Flow<N, H>& flow, Eigen::Index j, const Instant<N, H>& before, double slope,
              Workspace<N, H>& w) {
  if (slope == 0.0) return;
  const StepEquations<N, H>& eq = flow.equations();
  typename Sizes<N, H>::State by = Sizes<N, H>::State::Zero(eq.states());
  by.head(eq.masses()) = eq.bends.B.col(j);
  w.jumps.push_back({.contact = -1, .change = (w.left.a - before.a) / slope, .by = by});
}

}  // namespace frahm::periodic
