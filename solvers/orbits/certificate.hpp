#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/algebra/no_value.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/orbits/rest_directions.hpp"
#include "solvers/orbits/shooting.hpp"
#include "solvers/orbits/spectral_radius.hpp"

// The certificate of an orbit: Floquet multipliers, contraction in the energy norm, and the error bound that
// follows from them.
namespace frahm::periodic {

// The part of a tangent matrix that can contract. The rest positions of contacts that stick throughout never
// change (multiplier +1); they are projected out orthogonally in the energy norm. So are displacements in
// free directions, and velocities that nothing takes up: by projection, not by value, as a velocity that is
// free makes a Jordan block of the two multipliers +1, which rounding splits.
template <int N, int H>
typename Sizes<N, H>::StateSquare moving_part(Flow<N, H>& flow,
                                              const typename Sizes<N, H>::StateSquare& tangent,
                                              ContactMask stuck_throughout, const Closing& closing) {
  if (closing.is_modulo()) {
    typename Sizes<N, H>::StateSquare projector =
        Sizes<N, H>::StateSquare::Identity(tangent.rows(), tangent.rows());
    closing.project(projector);
    const typename Sizes<N, H>::StateSquare beside = moving_part(flow, tangent, stuck_throughout, Closing());
    return projector * beside * projector;
  }
  if (stuck_throughout == 0) return tangent;
  const Eigen::Index n = flow.equations().masses();
  typename Sizes<N, H>::StateSquare off =
      -shift_projector(rest_directions(flow.equations(), stuck_throughout));
  off.diagonal().array() += 1.0;
  off.block(n, n, n, n) = flow.keeping_stuck(stuck_throughout);
  return off * tangent * off;
}

// ||A||_E, the largest factor by which a tangent matrix can stretch the energy norm.
template <int N, int H>
double energy_operator_norm(const StepEquations<N, H>& eq, const typename Sizes<N, H>::StateSquare& A) {
  using S = Sizes<N, H>;
  const Eigen::Index n = eq.masses();
  // ||A||_E = ||R A R^-1||_2 with R^T R = blockdiag(K, M, 1/k of the internal forces); on what is left of A
  // where displacements are free, the springs of K_root there do not count.
  typename S::StateSquare B = A;
  B.topRows(n) = (eq.K_root * B.topRows(n)).eval();
  B.middleRows(n, n) = (eq.M_root * B.middleRows(n, n)).eval();
  B.leftCols(n) = (B.leftCols(n) * eq.K_root_inverse).eval();
  B.middleCols(n, n) = (B.middleCols(n, n) * eq.M_root_inverse).eval();
  if constexpr (S::kInternal != 0) {
    const Eigen::VectorXd root = eq.internal_stiffness.cwiseSqrt();
    B.bottomRows(root.size()).array().colwise() /= root.array();
    B.rightCols(root.size()).array().rowwise() *= root.transpose().array();
  }
  const typename S::StateSquare gram = B.transpose() * B;
  constexpr int kSquarings = 20;  // symmetric: the error is log(2n) / 2^20, on the low side
  return std::sqrt(spectral_radius(gram, kSquarings));
}

// The energy norm of the static responses to the contacts' forces, sqrt(w^T K^-1 w / 2) F: rounding of a
// force moves the state by that part of it. The force of a sliding contact is its limit. The force of a
// contact that sticks throughout is covered by the state's own scale.
template <int N, int H>
double static_forces(const Flow<N, H>& flow, const Orbit<N, H>& orbit) {
  const StepEquations<N, H>& eq = flow.equations();
  double sum = 0.0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (contains(orbit.stuck_throughout, j)) continue;
    sum += eq.limit[j] * std::sqrt(0.5 * eq.W.col(j).dot(eq.K_inverse * eq.W.col(j)));
  }
  return sum;
}

// The largest displacement of a node by a state of energy norm 1 [m / sqrt(J)]:
//   max_n sqrt(2 (K^-1)_nn),   or   max_n sqrt(2 (K^+)_nn) + (T/2) sqrt(2 (R R^T)_nn)
// with free directions R, R^T M R = 1, along which velocities of up to sqrt(2 E) have a period T to part from
// a mean of zero, and K^+ without them. Of joints x = B q + X s it is that of (B K^-1 B^T + X diag(k)
// X^T)_nn.
template <int N, int H>
double displacement_of_energy(const StepEquations<N, H>& eq, const Closing& closing) {
  if (!closing.is_modulo() && !eq.joints.any()) return std::sqrt(2.0 * eq.K_inverse.diagonal().maxCoeff());
  const Eigen::Index n = eq.masses(), joints = eq.joints.B.rows();
  Eigen::MatrixXd places(n + joints, n);  // of masses and joints, by the masses
  places << Eigen::MatrixXd::Identity(n, n), eq.joints.B;
  Eigen::VectorXd held = (places * eq.K_inverse * places.transpose()).diagonal();
  if (eq.joints.any())
    held.tail(joints) +=
        (eq.joints.X * eq.internal_stiffness.asDiagonal() * eq.joints.X.transpose()).diagonal();
  if (!closing.is_modulo()) return std::sqrt(2.0 * held.maxCoeff());
  const Eigen::VectorXd free = (places * closing.directions()).rowwise().squaredNorm();
  held -= eq.step * eq.step * free;
  const double half_period = 0.5 * eq.period * eq.step;
  return ((2.0 * held.cwiseMax(0.0)).cwiseSqrt() + half_period * (2.0 * free).cwiseSqrt()).maxCoeff();
}

// Contraction, Floquet radius and error bound of a converged orbit:
//   ||z - z*||_E <= (||r||_E + rounding) / (1 - L),   |x_n| <= displacement_of_energy ||z||_E,
// as long as the events are the same throughout that ball and all laws are monotone.
template <int N, int H>
void judge_stability(Flow<N, H>& flow, Orbit<N, H>& orbit) {
  const StepEquations<N, H>& eq = flow.equations();
  follow_tangent(flow, orbit);
  const auto moving = moving_part(flow, orbit.passage.tangent, orbit.stuck_throughout, orbit.closing);
  orbit.contraction = energy_operator_norm<N, H>(eq, moving);
  orbit.floquet_radius = spectral_radius(moving);
  if (orbit.half_period) orbit.floquet_radius *= orbit.floquet_radius;
  // Where an event only just happens the map has a kink and no derivative.
  const bool has_kink = orbit.passage.margin < kGrazing && orbit.passage.events > 0;
  if (has_kink) orbit.floquet_radius = kNone;

  const double scale = flow.energy_scale(orbit.z);
  const double operations = 16.0 + 2.0 * eq.period + 16.0 * orbit.passage.events;
  const double rounding =
      std::numeric_limits<double>::epsilon() * operations * (scale + static_forces(flow, orbit));
  const double ball = (orbit.residual * scale + rounding) / (1.0 - orbit.contraction);
  const bool holds = eq.monotone && orbit.contraction < 1.0 && ball < 0.1 * orbit.passage.margin * scale;
  orbit.error_bound = holds ? ball * displacement_of_energy(eq, orbit.closing) : kNone;
}

}  // namespace frahm::periodic
