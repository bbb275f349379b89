#pragma once

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

// The tangent across an event at which a guard g(z, t) reaches zero with the slope g', the fields f before
// and after (Leine and Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004, ch. 7):
//   dz+ = dz- + (f+ - f-) (grad g dz-) / g'
// - a velocity that reaches zero:  dv+ = dv- + (a+ - a-)(w^T dv-)/(w^T a- + p^T y''); exact for a reversal
//   and for a stop, where it is the M-orthogonal projection onto the stuck velocities. If contacts arrive
//   together, each adds its own share; the first also adds the share of stuck contacts that they release:
//   only contacts that move as one with them let go at once. A contact whose force is a state leaves a
//   unchanged: nothing jumps.
// - a force lambda that reaches its limit leaves a unchanged: nothing jumps.
// - an internal force s that does: s' falls from g' to 0, so that ds+ = ds- + (0 - g') ds-/g' = 0.
// before: the event's instant seen from inside the mode before it; w.left: from inside the mode after.
template <int N, int H>
void saltate(const Flow<N, H>& flow, ContactMask arrived, ContactMask released, const Instant<N, H>& before,
             const Mode<N, H>& mode_before, const Workspace<N, H>& w,
             typename Sizes<N, H>::StateSquare& tangent) {
  using S = Sizes<N, H>;
  const StepEquations<N, H>& eq = flow.equations();
  const Mode<N, H>& mode = flow.mode(w.mode);
  const Eigen::Index n = eq.masses();
  const bool alone = count(arrived & eq.holding) == 1;
  Eigen::Matrix<double, N, S::kState> correction;
  correction.setZero(n, eq.states());
  typename S::Vector left = w.left.a - before.a;        // the part of the jump that no contact has added yet
  using Earlier = Eigen::Matrix<double, 1, S::kState>;  // time lead of an arrival, a unit of the state
  Earlier earlier = Earlier::Zero(eq.states());
  bool is_first = true;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (!contains(arrived, j)) continue;
    const double slope = flow.sliding_speed(before, j).slope;
    if (slope == 0.0 || !eq.holds(j)) continue;
    const Earlier its_earlier = eq.W.col(j).transpose() * tangent.middleRows(n, n) / slope;
    if (is_first) earlier = its_earlier;
    is_first = false;
    typename S::Vector change = left;
    if (!alone) {
      // Its force's jump, with what the contacts that stuck before then take up.
      const double after =
          contains(mode.stuck, j) ? flow.stuck_force(w.left, mode, j).value : mode.friction[j];
      typename S::Contacts jump = S::Contacts::Zero(eq.contacts());
      jump[j] = after - mode_before.friction[j];
      change = flow.configuration(mode_before).pull_of_friction(eq, jump);
    }
    correction += change * its_earlier;
    left -= change;
  }
  correction += left * earlier;
  tangent.middleRows(n, n) += correction;
  if constexpr (S::kInternal != 0) {
    for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
      if (contains(released & ~eq.holding, j))
        tangent.row(2 * n + eq.internal_of[static_cast<std::size_t>(j)]).setZero();
    }
  }
}

// Whether the force of a contact falls where it lets go.
template <int N, int H>
bool falls_at_release(const StepEquations<N, H>& eq, Eigen::Index j) {
  return eq.holds(j) && eq.static_limit[j] != eq.limit[j];
}

// A stuck contact that lets go of a static limit: its force falls and the acceleration jumps,
//   dv+ = dv- + (a+ - a-) (grad lambda dz-) / lambda'
template <int N, int H>
void saltate_release(const Flow<N, H>& flow, Eigen::Index j, const Instant<N, H>& before,
                     const Mode<N, H>& mode_before, const Workspace<N, H>& w,
                     typename Sizes<N, H>::StateSquare& tangent) {
  const StepEquations<N, H>& eq = flow.equations();
  if (!falls_at_release(eq, j)) return;
  const Eigen::Index n = eq.masses();
  const Configuration<N, H>& c = flow.configuration(mode_before);
  const double slope = flow.stuck_force(before, mode_before, j).slope;
  if (slope == 0.0) return;
  Eigen::Matrix<double, 1, Sizes<N, H>::kState> by_state =
      c.Lq.row(j) * tangent.topRows(n) + c.Lv.row(j) * tangent.middleRows(n, n);
  if constexpr (Sizes<N, H>::kInternal != 0)
    by_state += c.Ls.row(j) * tangent.bottomRows(eq.internal_forces());
  tangent.middleRows(n, n) += ((w.left.a - before.a) / slope) * by_state;
}

// An element whose force jumps where it bends, at a place of the displacement:
//   dv+ = dv- + (a+ - a-) (b^T dq-) / (b^T v + p^T y')
template <int N, int H>
void saltate_bend(const Flow<N, H>& flow, Eigen::Index j, const Instant<N, H>& before, double slope,
                  const Workspace<N, H>& w, typename Sizes<N, H>::StateSquare& tangent) {
  if (slope == 0.0) return;
  const Eigen::Index n = flow.equations().masses();
  const Eigen::Matrix<double, 1, Sizes<N, H>::kState> by_state =
      flow.equations().bends.B.col(j).transpose() * tangent.topRows(n);
  tangent.middleRows(n, n) += ((w.left.a - before.a) / slope) * by_state;
}

}  // namespace frahm::periodic
