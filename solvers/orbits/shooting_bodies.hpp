#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/algebra/no_value.hpp"
#include "solvers/orbits/reasons.hpp"
#include "solvers/orbits/rest_directions.hpp"
#include "solvers/orbits/shooting.hpp"

// Bodies of Shooting, for the files that instantiate it.
namespace frahm::periodic {

template <int N, int H>
void Shooting<N, H>::find(Orbit<N, H>& orbit, ContactMask held, int maps_first) {
  const double period = flow_.equations().period;
  section_ = orbit.section;
  sign_ = orbit.sign();
  length_ = orbit.half_period ? 0.5 * period : period;
  held_ = held;
  newton_iterations_ = passages_ = 0;
  if (period > options_.most_steps_a_period) {
    current_.passage.segments.clear();
    current_.passage.failure = kTooManySteps;
    return conclude(Verdict::gave_up, orbit);
  }
  current_.z = orbit.z;
  apply_map(current_);
  march(maps_first);
  Verdict verdict = judge();
  for (int maps = 2; verdict == Verdict::go_on;) verdict = take_newton_step() ? judge() : go_by_map(maps);
  if (verdict == Verdict::converged) start_at_rest();
  conclude(verdict, orbit);
}

template <int N, int H>
void Shooting<N, H>::apply_map(Trial<N, H>& trial) {
  const StepEquations<N, H>& eq = flow_.equations();
  const Tangent tangent = eq.is_large() ? Tangent::recorded : Tangent::followed;
  walk_.pass(trial.z, section_, length_, trial.passage, tangent, held_);
  ++passages_;
  trial.stuck_throughout = stuck_throughout(flow_, trial.passage);
  trial.residual = sign_ * trial.passage.end - trial.z;
  // L^T z of a contact that sticks throughout is constant: it drifts by rounding alone.
  if (sign_ > 0.0 && trial.stuck_throughout != 0)
    trial.residual -= shift_projector(rest_directions(eq, trial.stuck_throughout)) * trial.residual;
  trial.closing = closing_of(flow_, trial.passage);
  if (trial.closing.is_modulo()) {
    typename S::Oscillators u(eq.oscillators());
    eq.oscillators_at(section_, flow_.orders(), u);
    trial.closing.apply(trial.z, u, trial.residual);
  }
  trial.norm = closing_norm(eq, trial.residual);
  const double scale = flow_.energy_scale(trial.z);
  trial.relative = scale > 0.0 ? trial.norm / scale : trial.norm;
}

template <int N, int H>
typename Shooting<N, H>::Verdict Shooting<N, H>::judge() {
  if (current_.passage.failure != nullptr) return Verdict::gave_up;
  if (!(current_.relative > options_.tolerance)) return Verdict::converged;
  return passages_ > options_.most_passages ? Verdict::gave_up : Verdict::go_on;
}

template <int N, int H>
bool Shooting<N, H>::take_newton_step() {
  if constexpr (!S::is_fixed) {
    if (flow_.equations().is_large()) return take_kept_step();
  }
  return take_dense_step();
}

// B of Newton's step,  (1 - dg/dz) step = g(z) - z. A contact that sticks throughout keeps its rest position
// (multiplier +1); its equation is replaced by L^T step = 0.
template <int N, int H>
typename Sizes<N, H>::StateSquare Shooting<N, H>::newton_matrix(const typename S::StateSquare& tangent) {
  typename S::StateSquare B = -sign_ * tangent;
  current_.closing.project(B);
  B.diagonal().array() += 1.0;
  if (sign_ > 0.0 && current_.stuck_throughout != 0)
    B += shift_projector(rest_directions(flow_.equations(), current_.stuck_throughout));
  return B;
}

template <int N, int H>
bool Shooting<N, H>::take_dense_step() {
  const typename S::StateSquare B = newton_matrix(current_.passage.tangent);
  if constexpr (S::is_fixed && S::kState <= 4) {
    // In closed form; Newton's method forgives its rounding.
    return try_steps(B.inverse() * current_.residual);
  } else {
    return try_steps(B.partialPivLu().solve(current_.residual));
  }
}

// Where the map leads to the orbit by itself, a step that is refused leaves the search to it.
template <int N, int H>
bool Shooting<N, H>::try_steps(const typename S::State& step) {
  return flow_.equations().monotone ? try_step(step) : try_shorter_steps(step);
}

template <int N, int H>
KeptDerivative::Map Shooting<N, H>::map() const {
  return {section_, sign_, flow_.equations().step, sign_ > 0.0 ? current_.stuck_throughout : 0, held_};
}

// A step by the kept derivative, or, where that does not serve, by the derivative here.
template <int N, int H>
bool Shooting<N, H>::take_kept_step() {
  const double before = current_.norm;
  if (kept_.serves(map())) {
    if (try_step(kept_.step(current_.residual))) {
      const double needed = options_.tolerance / current_.relative;
      if (kept_.is_worth_renewing(current_.norm / before, needed)) kept_.forget();
      return true;
    }
    if (current_.relative <= options_.good_enough) return false;
  }
  typename S::StateSquare tangent;
  flow_.tangent_along(current_.passage.path, Precision::rough, tangent);
  kept_.set(map(), newton_matrix(tangent));
  return try_shorter_steps(kept_.step(current_.residual));
}

// The map has a kink wherever a contact begins to stop or to slide: the residual may fall on the way although
// it does not at the end.
template <int N, int H>
bool Shooting<N, H>::try_shorter_steps(const typename S::State& step) {
  double share = 1.0;
  for (int halvings = 0; halvings <= options_.most_halvings; ++halvings, share *= 0.5) {
    if (try_step(step, share)) return true;
  }
  return false;
}

// Whether this share of a step reduces the residual enough (by Armijo's rule); if so, it leads to the current
// trial.
template <int N, int H>
bool Shooting<N, H>::try_step(const typename S::State& step, double share) {
  candidate_.z = current_.z + share * step;
  if (!candidate_.z.allFinite() || !is_resolved(candidate_.z)) return false;
  ++newton_iterations_;
  apply_map(candidate_);
  if (candidate_.passage.failure != nullptr) return false;
  if constexpr (!S::is_fixed) {
    const typename S::State moved = share * step;
    if (flow_.equations().is_large())
      kept_.correct(moved, flow_.equations().weighted_by_energy(moved),
                    current_.residual - candidate_.residual);
  }
  if (!(candidate_.norm < (1.0 - options_.pays * share) * current_.norm)) return false;
  std::swap(current_, candidate_);
  return true;
}

// Where Newton's step does not serve; maps: in a row, more each time.
template <int N, int H>
typename Shooting<N, H>::Verdict Shooting<N, H>::go_by_map(int& maps) {
  if (current_.relative <= std::max(options_.good_enough, rounding())) return Verdict::converged;
  if (!flow_.equations().monotone) return Verdict::gave_up;  // the map does not lead to an orbit by itself
  constexpr double kNear = 1e-9;                             // of the relative residual
  const double before = current_.relative;
  march(maps);
  const bool turns = current_.relative > (1.0 - options_.turns) * before;
  if (turns && maps >= options_.most_turns) {
    step_to_middle();
  } else if (creeps(before, maps) && !glide() && current_.relative < kNear) {
    return Verdict::gave_up;
  }
  maps = std::min(2 * maps, options_.most_maps);
  return judge();
}

template <int N, int H>
void Shooting<N, H>::march(int maps) {
  for (int i = 0; i < maps && current_.passage.failure == nullptr && current_.relative > options_.tolerance;
       ++i) {
    current_.z = image(current_);
    apply_map(current_);
  }
}

// Where the map takes a state, modulo what is free.
template <int N, int H>
typename Sizes<N, H>::State Shooting<N, H>::image(const Trial<N, H>& trial) const {
  if (trial.closing.is_modulo()) return trial.z + trial.residual;
  return sign_ * trial.passage.end;
}

// Whether the map would take more passages than the search may at the rate of these maps.
template <int N, int H>
bool Shooting<N, H>::creeps(double before, int maps) const {
  if (maps < options_.most_maps || !(current_.relative > options_.good_enough)) return false;
  const double removed = std::log(before / current_.relative);
  const double wanted = std::log(current_.relative / options_.good_enough);
  return wanted * maps > removed * options_.most_passages;
}

// Where the response is nearly vertical over a parameter the map is all but the identity along one direction:
// its orbit lies at the end of a long curved valley of the residual, in which Newton's steps leave the
// ground. The motion z' = g(z) - z goes down that valley, as g expands no distance, and an implicit step of
// it,
//   (1 - dg/dz + e) step = g(z) - z,
// becomes Newton's as e falls. e follows what the residual allows. False, at the least residual met, where it
// does not come to the orbit.
template <int N, int H>
bool Shooting<N, H>::glide() {
  constexpr double kMayRise = 1.5, kLargest = 1.0;  // e = 1: no step is longer than one of the map
  constexpr int kMostSteps = 2000;
  if (current_.passage.failure != nullptr) return false;
  Trial<N, H> best = current_;
  double e = 0.1;
  for (int step = 0; step < kMostSteps && e <= kLargest; ++step) {
    if (current_.relative <= options_.good_enough || passages_ > options_.most_passages) break;
    typename S::StateSquare B = newton_matrix(tangent_here());
    B.diagonal().array() += e;
    candidate_.z = current_.z + B.partialPivLu().solve(current_.residual);
    if (!candidate_.z.allFinite() || !is_resolved(candidate_.z)) break;
    ++newton_iterations_;
    apply_map(candidate_);
    const bool serves = candidate_.passage.failure == nullptr && candidate_.norm < kMayRise * best.norm;
    if (serves) std::swap(current_, candidate_);
    if (serves && current_.norm < best.norm) best = current_;
    e *= serves ? 0.5 : 4.0;
  }
  current_ = best;
  return current_.relative <= options_.good_enough;
}

template <int N, int H>
typename Sizes<N, H>::StateSquare Shooting<N, H>::tangent_here() const {
  if (!flow_.equations().is_large()) return current_.passage.tangent;
  typename S::StateSquare tangent;
  flow_.tangent_along(current_.passage.path, Precision::exact, tangent);
  return tangent;
}

// What rounding may leave of the relative residual: of all steps and events of a passage.
template <int N, int H>
double Shooting<N, H>::rounding() const {
  const double operations = 16.0 + 2.0 * length_ + 16.0 * current_.passage.events;
  return operations * std::numeric_limits<double>::epsilon();
}

// z := (z + g(z)) / 2. The map of a monotone system takes no two states further apart in energy, yet it may
// turn about its orbit without end: where contacts creep to their limits, half a period later the state is
// its own mirror image for ever. Such means come to an orbit wherever there is one (Krasnosel'skii 1955, Mann
// 1953).
template <int N, int H>
void Shooting<N, H>::step_to_middle() {
  if (current_.passage.failure != nullptr) return;
  current_.z += 0.5 * current_.residual;
  apply_map(current_);
}

// Newton's step may leave a contact just above rest, with a slip of zero length at the start. The end of the
// passage is on the same orbit and has no such slip.
template <int N, int H>
void Shooting<N, H>::start_at_rest() {
  constexpr double kNoLength = 1e-9;  // of the passage
  const auto& segments = current_.passage.segments;
  if (segments.size() < 2 || segments.front().length > kNoLength * length_) return;
  candidate_.z = image(current_);
  apply_map(candidate_);
  const bool serves = candidate_.passage.failure == nullptr && candidate_.relative <= options_.good_enough;
  if (serves) std::swap(current_, candidate_);
}

// Where the period map is all but the identity (a mode without damping at its resonance) Newton's step may
// lead so far out that any state there seems to close: its residual is lost in the rounding of the state.
template <int N, int H>
bool Shooting<N, H>::is_resolved(const typename S::State& z) const {
  const double largest = options_.most_magnification * flow_.static_norm();
  return largest == 0.0 || flow_.equations().energy_norm(z) <= largest;
}

template <int N, int H>
void Shooting<N, H>::conclude(Verdict verdict, Orbit<N, H>& orbit) {
  std::swap(orbit.passage, current_.passage);
  orbit.newton_iterations = newton_iterations_;
  orbit.passages = passages_;
  orbit.reason.clear();
  orbit.status = Status::failed;
  if (orbit.passage.failure != nullptr) {
    orbit.reason = orbit.passage.failure;
    orbit.residual = kNone;
    return;
  }
  orbit.z = current_.z;
  orbit.stuck_throughout = current_.stuck_throughout;
  orbit.closing = current_.closing;
  orbit.residual = current_.relative;
  if (verdict != Verdict::converged) {
    orbit.reason = no_convergence(passages_, current_.relative);
  } else if (!is_resolved(orbit.z)) {
    orbit.reason = kUnresolved;
  } else {
    orbit.status = orbit.passage.margin < kGrazing ? Status::grazing : Status::ok;
  }
}

}  // namespace frahm::periodic
