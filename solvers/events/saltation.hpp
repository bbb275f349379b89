#pragma once

#include <optional>

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
// - a velocity that reaches zero:  dv+ = dv- + (a+ - a-)(w^T dv-)/(w^T a- + p^T y''); exact for a reversal
//   and for a stop, where it is the M-orthogonal projection onto the stuck velocities. If contacts arrive
//   together, each adds its own share; the first also adds the share of stuck contacts that they release:
//   only contacts that move as one with them let go at once. A contact whose force is a state leaves a
//   unchanged: nothing jumps.
// - a force lambda that reaches its limit leaves a unchanged: nothing jumps.
// - an internal force s that does: s' falls from g' to 0, so that ds+ = ds- + (0 - g') ds-/g' = 0.
// before: the event's instant seen from inside the mode before it; w.left: from inside the mode after.
// Calls add(j, slope, change) for each part of the velocities' jump,  dv+ = dv- + change (w_j^T dv-) / slope.
template <int N, int H, class Add>
void for_each_jump(const Flow<N, H>& flow, ContactMask arrived, const Instant<N, H>& before,
                   const Mode<N, H>& mode_before, const Workspace<N, H>& w, const Add& add) {
  using S = Sizes<N, H>;
  const StepEquations<N, H>& eq = flow.equations();
  const Mode<N, H>& mode = flow.mode(w.mode);
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

// Carries the tangent of a small system across an event.
template <int N, int H>
void saltate(const Flow<N, H>& flow, ContactMask arrived, ContactMask released, const Instant<N, H>& before,
             const Mode<N, H>& mode_before, const Workspace<N, H>& w,
             typename Sizes<N, H>::StateSquare& tangent) {
  using S = Sizes<N, H>;
  const StepEquations<N, H>& eq = flow.equations();
  const Eigen::Index n = eq.masses();
  Eigen::Matrix<double, N, S::kState> correction;
  correction.setZero(n, eq.states());
  const auto add = [&](Eigen::Index j, double slope, const typename S::Vector& change) {
    const Eigen::Matrix<double, 1, S::kState> earlier =  // time lead of the arrival, a unit of the state
        eq.W.col(j).transpose() * tangent.middleRows(n, n) / slope;
    correction += change * earlier;
  };
  for_each_jump(flow, arrived, before, mode_before, w, add);
  tangent.middleRows(n, n) += correction;
  if constexpr (S::kInternal != 0) {
    for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
      if (contains(released & ~eq.holding, j))
        tangent.row(2 * n + eq.internal_of[static_cast<std::size_t>(j)]).setZero();
    }
  }
}

// A jump of the tangent of rank one:  dv+ = dv- + change (by^T dz-).
template <int N, int H>
struct RankOne {
  typename Sizes<N, H>::Vector change;
  typename Sizes<N, H>::State by;
};

// Whether the force of a contact falls where it lets go.
template <int N, int H>
bool falls_at_release(const StepEquations<N, H>& eq, Eigen::Index j) {
  return eq.holds(j) && eq.static_limit[j] != eq.limit[j];
}

// A stuck contact that lets go of a static limit: its force falls and the acceleration jumps,
//   dv+ = dv- + (a+ - a-) (grad lambda dz-) / lambda'
template <int N, int H>
std::optional<RankOne<N, H>> jump_of_release(const Flow<N, H>& flow, Eigen::Index j,
                                             const Instant<N, H>& before, const Mode<N, H>& mode_before,
                                             const Workspace<N, H>& w) {
  const StepEquations<N, H>& eq = flow.equations();
  if (!falls_at_release(eq, j)) return {};
  const Configuration<N, H>& c = flow.configuration(mode_before);
  const double slope = flow.stuck_force(before, mode_before, j).slope;
  if (slope == 0.0) return {};
  RankOne<N, H> jump{(w.left.a - before.a) / slope, Sizes<N, H>::State::Zero(eq.states())};
  jump.by.head(eq.masses()) = c.Lq.row(j).transpose();
  jump.by.segment(eq.masses(), eq.masses()) = c.Lv.row(j).transpose();
  if constexpr (Sizes<N, H>::kInternal != 0) jump.by.tail(eq.internal_forces()) = c.Ls.row(j).transpose();
  return jump;
}

// An element whose force jumps where it bends, at a place of the displacement:
//   dv+ = dv- + (a+ - a-) (b^T dq-) / (b^T v + p^T y')
template <int N, int H>
std::optional<RankOne<N, H>> jump_of_bend(const Flow<N, H>& flow, Eigen::Index j, const Instant<N, H>& before,
                                          double slope, const Workspace<N, H>& w) {
  if (slope == 0.0) return {};
  const StepEquations<N, H>& eq = flow.equations();
  RankOne<N, H> jump{(w.left.a - before.a) / slope, Sizes<N, H>::State::Zero(eq.states())};
  jump.by.head(eq.masses()) = eq.bends.B.col(j);
  return jump;
}

// Records the same at the end of a stretch.
template <int N, int H>
void record_saltation(const Flow<N, H>& flow, ContactMask arrived, ContactMask released,
                      const Instant<N, H>& before, const Mode<N, H>& mode_before, const Workspace<N, H>& w,
                      TangentPath::Stretch& stretch) {
  const StepEquations<N, H>& eq = flow.equations();
  const auto add = [&](Eigen::Index j, double slope, const typename Sizes<N, H>::Vector& change) {
    stretch.jumps.push_back({.contact = static_cast<int>(j), .change = change / slope});
  };
  for_each_jump(flow, arrived, before, mode_before, w, add);
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (contains(released & ~eq.holding, j))
      stretch.stopped.push_back(static_cast<int>(eq.internal_of[static_cast<std::size_t>(j)]));
  }
}

}  // namespace frahm::periodic
