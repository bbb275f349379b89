#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "solvers/orbits/orbit.hpp"
#include "solvers/orbits/stability.hpp"

// The periodic orbit as a fixed point of the period map g, by Newton's method on g(z) - z = 0 with the exact
// derivative of g. Where a Newton step does not pay, the map itself is applied: for Coulomb friction it
// expands no distance in the energy norm, so the search converges whenever the map contracts.
namespace frahm::periodic {

struct ShootingOptions {
  double tolerance = 1e-13;    // of the relative residual: a few units of rounding of one passage
  double good_enough = 1e-12;  // accepted when rounding keeps the residual from falling further
  int most_passages = 20000;   // enough for the map alone at damping ratios of 1e-3
  double most_steps = 2e7;     // of all passages together: about a second of work
  double most_steps_a_period = 2e5;
  double most_magnification = 1e13;  // of the static response: beyond, rounding of the orbit hides the forces
};

template <int N, int H>
class Shooting {
 public:
  using S = Sizes<N, H>;

  explicit Shooting(Flow<N, H>& flow, const ShootingOptions& options = {}) : flow_(flow), options_(options) {}

  // From the state in orbit.z at orbit.section; orbit.half_period says which map. Fills the rest of `orbit`.
  void find(Orbit<N, H>& orbit);

 private:
  void apply_map(Orbit<N, H>& orbit);
  bool newton_step(const Orbit<N, H>& orbit, typename S::State& step) const;
  bool is_resolved(const typename S::State& z) const;
  void march(Orbit<N, H>& orbit, int maps);

  Flow<N, H>& flow_;
  ShootingOptions options_;
  typename S::State residual_;
  double residual_norm_ = 0.0;
  Passage<N, H> kept_;
};

template <int N, int H>
void Shooting<N, H>::find(Orbit<N, H>& orbit) {
  orbit.status = Status::failed;
  orbit.reason = "";
  orbit.residual = std::numeric_limits<double>::quiet_NaN();
  orbit.passage.segments.clear();
  orbit.newton_iterations = orbit.passages = 0;
  if (flow_.equations().period > options_.most_steps_a_period) {
    orbit.reason = "the excitation is too slow, or the system too stiff: more than 200000 steps a period";
    return;
  }
  int maps = 2;
  apply_map(orbit);
  while (orbit.passage.failure == nullptr && orbit.residual > options_.tolerance) {
    const bool too_long = orbit.passages * flow_.equations().period > options_.most_steps;
    if (orbit.passages > options_.most_passages || too_long) {
      orbit.reason = "no convergence: the period map contracts too slowly";
      return;
    }
    typename S::State step;
    const bool has_step = newton_step(orbit, step) && is_resolved(orbit.z + step);
    if (has_step) {
      const typename S::State z = orbit.z, residual = residual_;
      const double norm = residual_norm_, relative = orbit.residual;
      std::swap(kept_, orbit.passage);
      orbit.z = z + step;
      ++orbit.newton_iterations;
      apply_map(orbit);
      constexpr double kPays = 0.9;
      if (orbit.passage.failure == nullptr && residual_norm_ < kPays * norm) continue;
      orbit.z = z;
      std::swap(kept_, orbit.passage);
      residual_ = residual;
      residual_norm_ = norm;
      orbit.residual = relative;
      if (relative <= options_.good_enough) break;
    }
    march(orbit, maps);
    maps = std::min(2 * maps, 256);
  }
  if (orbit.passage.failure != nullptr) {
    orbit.reason = orbit.passage.failure;
    return;
  }
  if (!is_resolved(orbit.z)) {
    orbit.reason = "the response is so much larger than the static one that rounding hides the forces";
    return;
  }
  orbit.status = orbit.passage.margin < kGrazing ? Status::grazing : Status::ok;
}

// residual_ = g(z) - z.
template <int N, int H>
void Shooting<N, H>::apply_map(Orbit<N, H>& orbit) {
  const StepEquations<N, H>& eq = flow_.equations();
  flow_.pass(orbit.z, orbit.section, orbit.half_period ? 0.5 * eq.period : eq.period, orbit.passage);
  ++orbit.passages;
  orbit.stuck_throughout = ~ContactMask{0};
  for (const Segment<N, H>& segment : orbit.passage.segments)
    orbit.stuck_throughout &= flow_.mode(segment.mode).stuck;
  residual_ = orbit.sign() * orbit.passage.end - orbit.z;
  residual_norm_ = eq.energy_norm(residual_);
  const double scale = std::max(eq.energy_norm(orbit.z), flow_.static_norm());
  orbit.residual = scale > 0.0 ? residual_norm_ / scale : residual_norm_;
}

// (1 - dg/dz) step = g(z) - z.
template <int N, int H>
bool Shooting<N, H>::newton_step(const Orbit<N, H>& orbit, typename S::State& step) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  typename S::StateSquare A = -orbit.sign() * orbit.passage.tangent;
  A.diagonal().array() += 1.0;
  if (!orbit.half_period && orbit.stuck_throughout != 0) {
    // A permanently stuck contact keeps its rest position (multiplier +1): w^T step = 0 in its place.
    for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
      if (!contains(orbit.stuck_throughout, j)) continue;
      A.topLeftCorner(n, n) += eq.W.col(j) * eq.W.col(j).transpose();
    }
  }
  if constexpr (S::is_fixed && S::kState <= 4) {
    step = A.inverse() * residual_;  // closed form; Newton's method forgives its rounding
  } else {
    step = A.partialPivLu().solve(residual_);
  }
  return step.allFinite();
}

// Where the period map is all but the identity (a mode without damping at its resonance) Newton's step may lead
// so far out that any state there seems to close: its residual is lost in the rounding of the state.
template <int N, int H>
bool Shooting<N, H>::is_resolved(const typename S::State& z) const {
  const double largest = options_.most_magnification * flow_.static_norm();
  return largest == 0.0 || flow_.equations().energy_norm(z) <= largest;
}

template <int N, int H>
void Shooting<N, H>::march(Orbit<N, H>& orbit, int maps) {
  for (int i = 0; i < maps && orbit.passage.failure == nullptr && orbit.residual > options_.tolerance; ++i) {
    orbit.z = orbit.sign() * orbit.passage.end;
    apply_map(orbit);
  }
}

// Contraction, Floquet radius and error bound of a converged orbit.
template <int N, int H>
void judge_stability(const Flow<N, H>& flow, Orbit<N, H>& orbit) {
  const StepEquations<N, H>& eq = flow.equations();
  const auto moving = moving_part<N, H>(eq, orbit.passage.tangent, orbit.stuck_throughout);
  orbit.contraction = energy_operator_norm<N, H>(eq, moving);
  orbit.floquet_radius = spectral_radius(moving);
  if (orbit.half_period) orbit.floquet_radius *= orbit.floquet_radius;
  // Where an event only just happens the map has a kink and no derivative.
  const bool has_kink = orbit.passage.margin < kGrazing && orbit.passage.events > 0;
  if (has_kink) orbit.floquet_radius = std::numeric_limits<double>::quiet_NaN();

  // ||z - z*||_E <= (||r||_E + rounding) / (1 - L), and |x_n| <= sqrt(2 (K^-1)_nn) ||z||_E.
  const double scale = std::max(eq.energy_norm(orbit.z), flow.static_norm());
  const double operations = 16.0 + 2.0 * eq.period + 16.0 * orbit.passage.events;
  const double rounding = std::numeric_limits<double>::epsilon() * operations * scale;
  const double ball = (orbit.residual * scale + rounding) / (1.0 - orbit.contraction);
  // The bound needs the same events throughout the ball.
  const bool holds = orbit.contraction < 1.0 && ball < 0.1 * orbit.passage.margin * scale;
  orbit.error_bound = holds ? ball * std::sqrt(2.0 * eq.K_inverse.diagonal().maxCoeff())
                            : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace frahm::periodic
