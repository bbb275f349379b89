#pragma once

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

// A velocity that reaches zero:  dv+ = dv- + (a+ - a-)(w^T dv-)/(w^T a- + p^T y''); exact for a reversal and
// for a stop, where it is the M-orthogonal projection onto the stuck velocities. If contacts arrive together,
// each adds its own share; the first also adds the share of stuck contacts that they release: only contacts
// that move as one with them let go at once. A contact whose force is a state leaves a unchanged: nothing
// jumps.
template <int N, int H>
void add_arrivals(const Flow<N, H>& flow, ContactMask arrived, const Instant<N, H>& before,
                  const Mode<N, H>& mode_before, Workspace<N, H>& w) {
  using S = Sizes<N, H>;
  const StepEquations<N, H>& eq = flow.equations();
  const Mode<N, H>& mode = flow.mode(w.mode);
  const auto add = [&](Eigen::Index j, double slope, const typename S::Vector& change) {
    w.jumps.push_back({.contact = static_cast<int>(j), .change = change / slope, .by = {}});
  };
  const bool alone = count(arrived & eq.holding) == 1;
  typename S::Vector left = w.left.a - before.a;  // the part of the jump that no contact has added yet
  Eigen::Index leader = -1;
  double leader_slope = 0.0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (!contains(arrived, j)) continue;
    const double slope = flow.sliding_speed(before, j).slope;
    if (slope == 0.0 || !eq.holds(j)) continue;
    if (alone) return add(j, slope, left);
    if (leader < 0) {
      leader = j;
      leader_slope = slope;
    }
    // Its force's jump, with what the contacts that stuck before then take up.
    const double after = contains(mode.stuck, j) ? flow.stuck_force(w.left, mode, j).value : mode.friction[j];
    typename S::Contacts jump = S::Contacts::Zero(eq.contacts());
    jump[j] = after - mode_before.friction[j];
    const typename S::Vector change = flow.configuration(mode_before).pull_of_friction(eq, jump);
    add(j, slope, change);
    left -= change;
  }
  if (leader >= 0) add(leader, leader_slope, left);
}

// Whether a force falls where contacts let go, of those that stuck in one mode and slide in the next.
template <int N, int H>
bool falls_at_release(const Flow<N, H>& flow, const Mode<N, H>& before, const Mode<N, H>& after) {
  const StepEquations<N, H>& eq = flow.equations();
  return !eq.monotone && some_fall(eq, before.stuck & ~flow.at_rest(after) & eq.holding);
}

// A force lambda that reaches its limit leaves a unchanged, unless it, or another with it, falls from a
// static limit: then
//   dv+ = dv- + (a+ - a-) (grad lambda dz-) / lambda'
template <int N, int H>
void add_release(const Flow<N, H>& flow, Eigen::Index j, const Instant<N, H>& before,
                 const Mode<N, H>& mode_before, Workspace<N, H>& w) {
  if (!falls_at_release(flow, mode_before, flow.mode(w.mode))) return;
  const double slope = flow.stuck_force(before, mode_before, j).slope;
  if (slope == 0.0) return;
  w.jumps.push_back(
      {.contact = -1, .change = (w.left.a - before.a) / slope, .by = flow.stuck_force_form(mode_before, j)});
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
