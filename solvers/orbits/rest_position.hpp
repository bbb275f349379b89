#pragma once

#include "solvers/quantities/extremes.hpp"
#include "solvers/quantities/integrals.hpp"

namespace frahm::periodic {

struct RestShift {
  Eigen::VectorXd displacement;  // of each mass [m]
  bool at_limit = false;         // some contact's force reaches its limit
};

// delta with lower <= delta <= upper that minimises 1/2 q^T K q, q = q_mean - K^-1 W delta.
// Shapes: K_inverse n x n, W n x m, q_mean n; lower, upper, limit m [N].
RestShift least_energy_shift(const Eigen::MatrixXd& K_inverse, const Eigen::MatrixXd& W,
                             const Eigen::VectorXd& q_mean, const Eigen::VectorXd& lower,
                             const Eigen::VectorXd& upper, const Eigen::VectorXd& limit);

// Contacts that never slide may rest anywhere in an interval. A shift of their mean forces by delta moves the
// whole orbit by -K^-1 W delta and leaves every velocity as it is, so all of these orbits are periodic. By
// convention the mean position of least energy is taken,
//   minimise 1/2 q^T K q,  q = q_mean - K^-1 W delta,  |lambda_j(t) + delta_j| <= F_j.
// Moves `orbit` there; one whose limit is reached is grazing. False, and the orbit as it was, where no rest
// position keeps the forces within their limits.
template <int N, int H>
bool settle_rest_position(const mechanics::Assembly& assembly, const Flow<N, H>& flow,
                          OrbitSteps<N, H>& steps, Integrals<N, H>& integrals, Orbit<N, H>& orbit) {
  const StepEquations<N, H>& eq = flow.equations();
  const Eigen::Index n = eq.masses(), m = __builtin_popcountll(orbit.stuck_throughout);
  steps.lay_out(orbit);
  integrals.integrate(steps, flow, orbit.half_period, [](const auto&, auto& powers) { powers.clear(); });
  const double period = 2.0 * std::numbers::pi / flow.fundamental_rate() * eq.step;
  const typename Sizes<N, H>::Vector mean = integrals.gram().col(eq.states()).head(n) / period;

  const Forms<N, H> forms(assembly, flow);
  Eigen::MatrixXd W(n, m);
  Eigen::VectorXd lower(m), upper(m), limit(m);
  for (Eigen::Index j = 0, row = 0; j < eq.contacts(); ++j) {
    if (!contains(orbit.stuck_throughout, j)) continue;
    const Extremes force = find_extremes(steps, flow, orbit.section, [&](const Mode<N, H>& mode) {
      return forms.stuck_contact_force(j, mode);
    });
    W.col(row) = eq.W.col(j);
    limit[row] = eq.limit[j];
    lower[row] = -eq.limit[j] - force.least;
    upper[row] = eq.limit[j] - force.most;
    if (lower[row] > upper[row] + kTie * eq.limit[j]) return false;
    upper[row] = std::max(upper[row], lower[row]);
    ++row;
  }
  const RestShift shift = least_energy_shift(eq.K_inverse, W, mean, lower, upper, limit);
  orbit.z.head(n) += shift.displacement;
  orbit.passage.end.head(n) += shift.displacement;
  for (Segment<N, H>& segment : orbit.passage.segments) segment.z.head(n) += shift.displacement;
  if (shift.at_limit) orbit.status = Status::grazing;
  return true;
}

// Under symmetric forcing the rest positions have zero mean, so contacts to a fixed support that never slide
// rest at zero: takes the rounding out of them, orthogonally in the norm of K.
template <int N, int H>
void centre_rest_position(const Flow<N, H>& flow, Orbit<N, H>& orbit) {
  const StepEquations<N, H>& eq = flow.equations();
  const Eigen::Index n = eq.masses();
  Eigen::MatrixXd W(n, 0);
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (!contains(orbit.stuck_throughout, j) || !eq.support_velocity.row(j).isZero(0.0)) continue;
    W.conservativeResize(n, W.cols() + 1);
    W.rightCols(1) = eq.W.col(j);
  }
  if (W.cols() == 0) return;
  const typename Sizes<N, H>::Square off = projector_off(eq.K, W);
  const auto centre = [&](typename Sizes<N, H>::State& z) { z.head(n) = (off * z.head(n)).eval(); };
  centre(orbit.z);
  centre(orbit.passage.end);
  for (Segment<N, H>& segment : orbit.passage.segments) centre(segment.z);
}

}  // namespace frahm::periodic
