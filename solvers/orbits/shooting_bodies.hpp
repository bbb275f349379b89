#pragma once

#include <Eigen/LU>

#include "solvers/algebra/no_value.hpp"
#include "solvers/orbits/reasons.hpp"
#include "solvers/orbits/rest_directions.hpp"
#include "solvers/orbits/shooting.hpp"

// Bodies of Shooting, for the files that instantiate it.
namespace frahm::periodic {

template <int N, int H>
void Shooting<N, H>::find(Orbit<N, H>& orbit, ContactMask held) {
  const double period = flow_.equations().period;
  section_ = orbit.section;
  sign_ = orbit.sign();
  length_ = orbit.half_period ? 0.5 * period : period;
  held_ = held;
  newton_iterations_ = passages_ = 0;
  const bool keeps = flow_.equations().is_large() && held == 0;
  tangent_ = keeps ? Tangent::none : Tangent::followed;
  if (period > options_.most_steps_a_period) {
    current_.passage.segments.clear();
    current_.passage.failure = kTooManySteps;
    return conclude(Verdict::gave_up, orbit);
  }
  current_.z = orbit.z;
  apply_map(current_, tangent_);
  Verdict verdict = judge();
  for (int maps = 2; verdict == Verdict::go_on; verdict = judge()) {
    if (keeps ? take_kept_step() : take_newton_step()) continue;
    if (!flow_.equations().monotone && take_short_step()) continue;
    if (current_.relative <= options_.good_enough) {
      verdict = Verdict::converged;
      break;
    }
    if (!flow_.equations().monotone) {
      verdict = Verdict::gave_up;
      break;
    }
    march(maps);
    maps = std::min(2 * maps, 256);
  }
  if (verdict == Verdict::converged) start_at_rest();
  conclude(verdict, orbit);
}

template <int N, int H>
void Shooting<N, H>::apply_map(Trial<N, H>& trial, Tangent tangent) {
  const StepEquations<N, H>& eq = flow_.equations();
  walk_.pass(trial.z, section_, length_, trial.passage, tangent, held_);
  ++passages_;
  trial.stuck_throughout = stuck_throughout(flow_, trial.passage);
  trial.residual = sign_ * trial.passage.end - trial.z;
  // L^T z of a contact that sticks throughout is constant: it drifts by rounding alone.
  if (sign_ > 0.0 && trial.stuck_throughout != 0)
    trial.residual -= shift_projector(rest_directions(eq, trial.stuck_throughout)) * trial.residual;
  trial.norm = eq.energy_norm(trial.residual);
  const double scale = flow_.energy_scale(trial.z);
  trial.relative = scale > 0.0 ? trial.norm / scale : trial.norm;
}

template <int N, int H>
typename Shooting<N, H>::Verdict Shooting<N, H>::judge() {
  if (current_.passage.failure != nullptr) return Verdict::gave_up;
  if (!(current_.relative > options_.tolerance)) return Verdict::converged;
  // The time of a step is proportional to the number of states.
  const double size = std::max(1.0, static_cast<double>(flow_.equations().states()) / 4.0);
  const bool too_long = passages_ * flow_.equations().period * size > options_.most_steps;
  return passages_ > options_.most_passages || too_long ? Verdict::gave_up : Verdict::go_on;
}

// B of Newton's step,  (1 - dg/dz) step = g(z) - z. A contact that sticks throughout keeps its rest position
// (multiplier +1); its equation is replaced by L^T step = 0.
template <int N, int H>
typename Sizes<N, H>::StateSquare Shooting<N, H>::newton_matrix() {
  typename S::StateSquare A = -sign_ * current_.passage.tangent;
  A.diagonal().array() += 1.0;
  if (sign_ > 0.0 && current_.stuck_throughout != 0)
    A += shift_projector(rest_directions(flow_.equations(), current_.stuck_throughout));
  return A;
}

template <int N, int H>
bool Shooting<N, H>::take_newton_step() {
  const typename S::StateSquare A = newton_matrix();
  if constexpr (S::is_fixed && S::kState <= 4) {
    // In closed form; Newton's method forgives its rounding.
    if (!propose(A.inverse() * current_.residual)) return false;
  } else {
    if (!propose(A.partialPivLu().solve(current_.residual))) return false;
  }
  return try_candidate(Tangent::followed, options_.pays);
}

// Parts of Newton's step, where the whole leads too far: under laws that are not monotone the map does not
// lead to the orbit by itself.
template <int N, int H>
bool Shooting<N, H>::take_short_step() {
  constexpr int kMostHalvings = 6;
  if (!current_.passage.has_tangent) apply_map(current_, Tangent::followed);
  const typename S::State step = newton_matrix().partialPivLu().solve(current_.residual);
  double part = 1.0;
  for (int i = 0; i < kMostHalvings; ++i) {
    part *= 0.5;
    if (propose(part * step) && try_candidate(Tangent::followed, 1.0 - 0.1 * part)) return true;
  }
  return false;
}

// A step by the kept derivative, which is taken anew where it does not serve.
template <int N, int H>
bool Shooting<N, H>::take_kept_step() {
  const KeptAt here{section_, sign_, flow_.equations().step, sign_ > 0.0 ? current_.stuck_throughout : 0};
  const bool serves = kept_.is_set() && kept_at_ == here;
  const double before = current_.norm;
  if (serves && propose(kept_.step(current_.residual)) && try_candidate(Tangent::none, options_.pays)) {
    if (wants_derivative(current_.norm / before)) kept_.forget();
    return true;
  }
  if (serves && current_.relative <= options_.good_enough) return false;
  if (!keep_derivative()) return false;
  kept_at_ = here;
  return propose(kept_.step(current_.residual)) && try_candidate(Tangent::none, options_.pays);
}

// Whether further steps, each of which leaves this part of the residual, would take longer than the
// derivative and the steps after it.
template <int N, int H>
bool Shooting<N, H>::wants_derivative(double left) const {
  constexpr double kStatesAPassage = 12.0;  // columns of the tangent that take as long as the passage itself
  constexpr double kAfterDerivative = 3.0;  // passages
  const double derivative = static_cast<double>(flow_.equations().states()) / kStatesAPassage;
  const double further = std::log(current_.relative / options_.tolerance) / -std::log(left);
  return further > derivative + kAfterDerivative;
}

// The derivative at the current state.
template <int N, int H>
bool Shooting<N, H>::keep_derivative() {
  kept_.forget();
  apply_map(current_, Tangent::followed);
  if (current_.passage.failure != nullptr) return false;
  kept_.set(newton_matrix());
  return true;
}

template <int N, int H>
bool Shooting<N, H>::propose(const typename S::State& step) {
  candidate_.z = current_.z + step;
  return candidate_.z.allFinite() && is_resolved(candidate_.z);
}

// Whether the candidate reduces the residual enough; if so, it becomes the current trial.
template <int N, int H>
bool Shooting<N, H>::try_candidate(Tangent tangent, double pays) {
  ++newton_iterations_;
  apply_map(candidate_, tangent);
  if (candidate_.passage.failure != nullptr) return false;
  if (tangent == Tangent::none) {
    const typename S::State step = candidate_.z - current_.z;
    kept_.correct(step, flow_.equations().weighted_by_energy(step), candidate_.residual);
  }
  if (!(candidate_.norm < pays * current_.norm)) return false;
  std::swap(current_, candidate_);
  return true;
}

template <int N, int H>
void Shooting<N, H>::march(int maps) {
  for (int i = 0; i < maps && current_.passage.failure == nullptr && current_.relative > options_.tolerance;
       ++i) {
    current_.z = sign_ * current_.passage.end;
    apply_map(current_, tangent_);
  }
}

// Newton's step may leave a contact just above rest, with a slip of zero length at the start. The end of the
// passage is on the same orbit and has no such slip.
template <int N, int H>
void Shooting<N, H>::start_at_rest() {
  constexpr double kNoLength = 1e-9;  // of the passage
  const auto& segments = current_.passage.segments;
  if (segments.size() < 2 || segments.front().length > kNoLength * length_) return;
  candidate_.z = sign_ * current_.passage.end;
  apply_map(candidate_, tangent_);
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
