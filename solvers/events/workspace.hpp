#pragma once

#include <vector>

#include "solvers/events/tolerances.hpp"
#include "solvers/flow/flow.hpp"

namespace frahm::periodic {

// A bound of a function's fourth derivative a step, where its fastest rate is kStepRate, per unit of its
// scale.
inline constexpr double kFourthDerivative = 2.0 * kStepRate * kStepRate * kStepRate * kStepRate;

// The current state of the motion within its passage.
template <int N, int H>
struct Workspace {
  using S = Sizes<N, H>;

  ContactMask held = 0;  // contacts that stick regardless of their force, to test if they stick throughout

  Instant<N, H> left, right;  // both ends of the current step
  Expansion<N, H> expansion;  // over the current step, if `expanded`
  bool expanded = false;
  std::size_t mode = 0;
  // For each contact its guard (events/search.hpp) at both ends of the step: that of `left` where it is
  // known.
  std::vector<ValueAndSlope> left_guard, right_guard;
  bool knows_left = false;
  std::vector<std::size_t> sharing;  // of each idle contact the mode in which it shares forces (loops.hpp)
  double clock = 0.0;                // steps since the passage began
  double behind = 0.0;               // steps since the last stretch of the path ended
  ContactMask fresh = 0;             // sliding contacts whose velocity is zero at `left`
  ContactMask just_released = 0;     // fresh contacts whose relative acceleration is zero too
  // Contacts chosen at this instant with regard to what follows just after it: nothing is left to decide.
  ContactMask settled = 0;
  ContactMask free = 0;                         // bends past their place that push no more (bend_guards.hpp)
  ContactMask at_place = 0, without_force = 0;  // bends whose guard is zero at `left`
  std::vector<JumpOf<typename S::Vector, typename S::State>> jumps;  // of the tangent, at the current event
  double margin = 1.0;                                               // see Passage::margin
  const char* undecided = nullptr;                                   // why a joint choice found no answer

  // Scales of the contacts' velocities [m a step] and forces [N]: those of the larger of the state's and the
  // static response's energy, plus a support's own motion.
  typename S::Contacts speed_scale, force_scale;
  // A contact's velocity below this counts as zero [m a step]: kRest of its scale, or what its own friction
  // stops within kRest of a step: the force of a strong contact rounds the velocities that it holds.
  typename S::Contacts rest_speed;
  // A bend's distance from its place [m], or [m a step] of a velocity, that is rounding.
  typename S::Contacts at_rest_on_place;

  // The state has left the instant of the last event.
  void leave_event() { fresh = just_released = at_place = without_force = 0; }
  void note_margin(double relative) { margin = std::min(margin, relative); }
  const Expansion<N, H>& expand(const Flow<N, H>& flow) {
    if (!expanded) flow.expand(left, flow.mode(mode), expansion);
    expanded = true;
    return expansion;
  }
};

// energy: Flow::energy_scale of the state where the passage begins.
template <int N, int H>
void set_scales(const Flow<N, H>& flow, double energy, Workspace<N, H>& w) {
  const StepEquations<N, H>& eq = flow.equations();
  const Eigen::Index m = eq.contacts();
  w.speed_scale.resize(m);
  w.force_scale.resize(m);
  w.rest_speed.resize(m);
  w.left_guard.resize(static_cast<std::size_t>(m));
  w.right_guard.resize(static_cast<std::size_t>(m));
  for (Eigen::Index j = 0; j < m; ++j) {
    // |w^T v| <= sqrt(w^T M^-1 w) sqrt(v^T M v)
    w.speed_scale[j] = std::sqrt(2.0 * eq.compliance[j]) * energy + eq.support_speed[j];
    const Eigen::Index internal = eq.internal_of[static_cast<std::size_t>(j)];
    w.force_scale[j] = internal < 0 ? kStepRate * w.speed_scale[j] / eq.compliance[j]
                                    : eq.internal_stiffness[internal] * w.speed_scale[j] / kStepRate;
    const double stopped_in_a_step = eq.holds(j) ? eq.limit[j] * eq.compliance[j] : 0.0;
    w.rest_speed[j] = kRest * std::max(w.speed_scale[j], stopped_in_a_step);
  }
  const StepBends<N, H>& bends = eq.bends;
  w.at_rest_on_place.resize(bends.count());
  for (Eigen::Index j = 0; j < bends.count(); ++j)
    w.at_rest_on_place[j] = kRest * (std::sqrt(2.0 * bends.B.col(j).dot(bends.MB.col(j))) * energy +
                                     bends.motion_velocity.row(j).norm());
}

}  // namespace frahm::periodic
