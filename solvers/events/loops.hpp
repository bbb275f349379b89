#pragma once

#include "solvers/events/passage.hpp"
#include "solvers/events/workspace.hpp"

// Contacts in loops: where stuck contacts alone hold a further contact at rest, a convention fixes its force:
// the forces are those of least sum (lambda_j / F_j)^2, as long as each is within its limit. A contact whose
// force would exceed its limit carries the limit, as if it slid, while the others hold it: it is idle
// (Configuration::idle). So no force ever exceeds its limit, and motion begins only when no distribution of
// the forces can hold the contacts.
namespace frahm::periodic {

// Idle contacts share the forces again as soon as all forces would then be within their limits.
template <int N, int H>
bool share_again(Flow<N, H>& flow, Workspace<N, H>& w) {
  constexpr double kWithin = 1.0 - 1e-9;  // so that a contact does not switch back and forth
  const ContactMask idle = flow.configuration(flow.mode(w.mode)).idle & flow.equations().holding;
  for (Eigen::Index j = 0; idle != 0 && j < flow.equations().contacts(); ++j) {
    if (!contains(idle, j)) continue;
    const ContactMask stuck = flow.mode(w.mode).stuck | bit(j);
    const std::size_t sharing = flow.mode_index(stuck, flow.mode(w.mode).positive, flow.mode(w.mode).beyond);
    bool within = true;
    for (Eigen::Index i = 0; i < flow.equations().contacts(); ++i) {
      if (!contains(stuck & flow.equations().holding & ~w.held, i)) continue;
      const double force = flow.stuck_force(w.left, flow.mode(sharing), i).value;
      within = within && std::abs(force) < kWithin * flow.equations().static_limit[i];
    }
    if (!within) continue;
    w.mode = sharing;
    flow.accelerate(flow.mode(w.mode), w.left);
    return true;
  }
  return false;
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

// Contacts that were idle before a release and can move after it. A contact that would move against its own
// friction sticks.
template <int N, int H>
void wake(Flow<N, H>& flow, ContactMask idle_before, Workspace<N, H>& w) {
  const ContactMask woken = idle_before & ~flow.configuration(flow.mode(w.mode)).idle;
  for (Eigen::Index j = 0; woken != 0 && j < flow.equations().contacts(); ++j) {
    const Mode<N, H>& mode = flow.mode(w.mode);
    if (!contains(woken & ~mode.stuck, j)) continue;
    const FirstMotion first = first_motion(flow, j, w);
    if (mode.sign(j) * first.sign < 0.0)
      w.mode = flow.mode_index(mode.stuck | bit(j), mode.positive, mode.beyond);
    else
      start_sliding(j, first, w);
  }
}

// A contact that was held at rest lets go. Contacts beside it whose internal force is at its limit continue
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
