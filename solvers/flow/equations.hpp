#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "solvers/flow/sizes.hpp"
#include "solvers/flow/sparse_system.hpp"
#include "solvers/flow/step_bends.hpp"
#include "solvers/mechanics/linear_system.hpp"

namespace frahm::periodic {

// Rows with row * u(t) = Re(constant + sum_k harmonic_k e^{i phi_k}):  Re(f e^{i phi}) = Re f cos phi - Im f
// sin phi.
template <class Rows>
void on_oscillators(const Eigen::VectorXd& constant, const Eigen::MatrixXcd& harmonic, Rows& rows) {
  rows.resize(constant.size(), 1 + 2 * harmonic.cols());
  rows.col(0) = constant;
  for (Eigen::Index k = 0; k < harmonic.cols(); ++k) {
    rows.col(1 + 2 * k) = harmonic.col(k).real();
    rows.col(2 + 2 * k) = -harmonic.col(k).imag();
  }
}

// The equation of motion with time counted in steps of length h, so that velocities are displacements a step:
//   (M/h^2) q'' + (C/h) q' + K q + D s = f(t) - W lambda,  s' = k (D^T q' + p^T y') - (rate h) s  (Maxwell)
// Energies and forces keep their units [J, N].
template <int N, int H>
struct StepEquations {
  using S = Sizes<N, H>;

  double step = 0.0;    // h [s]
  double period = 0.0;  // of the fundamental, in steps
  typename S::Square M, C, K, M_inverse, K_inverse;
  typename S::Square M_root, K_root, M_root_inverse, K_root_inverse;  // upper Cholesky factors: M = R^T R
  typename S::VectorByOscillators force;                              // f(t) = force * u(t) [N]
  typename S::VectorByOscillators force_pull;                         // M^-1 force
  typename S::VectorByOscillators applied_force;  // the part of it that acts on the masses from outside
  typename S::SupportsByOscillators motion, motion_velocity,
      motion_acceleration;             // y(t) of the prescribed nodes, without what a belt moves on
  typename S::VectorByContacts W, MW;  // directions of the contacts, M^-1 W (n x m)
  typename S::ContactSquare mobility;  // G = W^T M^-1 W
  bool has_loops = false;              // the directions of contacts depend on one another
  typename S::ContactsByOscillators support_velocity,
      support_acceleration;               // p_j^T y'(t), p_j^T y''(t), m rows
  typename S::Contacts limit;             // [N]
  typename S::Contacts static_limit;      // of the force at rest, >= limit [N]
  typename S::Contacts compliance;        // w_j^T M^-1 w_j
  ContactMask holding = 0;                // contacts whose law holds the velocity while they stick
  std::vector<Eigen::Index> internal_of;  // of each contact: its internal force, -1: none
  Eigen::MatrixXd D;                      // n x s
  Eigen::VectorXd internal_stiffness, internal_rate;  // k [N/m]; k/c times h, 0 without a damper
  Eigen::MatrixXd internal_drive;                     // k p^T y'(t) [N a step]
  Eigen::VectorXd phase_rate;                         // order_k omega h [rad a step], size H
  // cos + i sin of each harmonic at phase 0. Empty: 1, as in every motion except one with a measured
  // excitation.
  std::vector<std::complex<double>> oscillators_at_zero;
  StepBends<N, H> bends;
  bool monotone = true;          // LinearSystem::monotone
  SparseSystem sparse;           // of a large system
  SystemOf<float> sparse_rough;  // the same in single precision

  Eigen::Index masses() const { return M.rows(); }
  Eigen::Index contacts() const { return limit.size(); }
  // Whether Taylor series come from the equation itself (SparseSystem), not from tables of each
  // configuration.
  bool is_large() const { return !S::is_fixed && masses() >= kFromMasses; }
  static constexpr Eigen::Index kFromMasses = 8;  // as fast both ways there
  // Whether contact j holds its velocity at zero while it sticks; otherwise its force is a state.
  bool holds(Eigen::Index j) const { return contains(holding, j); }
  Eigen::Index internal_forces() const { return internal_stiffness.size(); }
  Eigen::Index states() const { return 2 * masses() + internal_forces(); }
  Eigen::Index oscillators() const { return force.cols(); }

  // d/dt of row * u(t):  cos' = -rate sin, sin' = rate cos.
  template <class Rows>
  void differentiate(const Rows& rows, Rows& result) const {
    result.col(0).setZero();
    for (Eigen::Index k = 0; k < phase_rate.size(); ++k) {
      result.col(1 + 2 * k) = phase_rate[k] * rows.col(2 + 2 * k);
      result.col(2 + 2 * k) = -phase_rate[k] * rows.col(1 + 2 * k);
    }
  }

  void oscillators_at(double fundamental_phase, const std::vector<int>& orders,
                      typename S::Oscillators& u) const {
    u[0] = 1.0;
    for (std::size_t k = 0; k < orders.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      u[1 + 2 * i] = std::cos(orders[k] * fundamental_phase);
      u[2 + 2 * i] = std::sin(orders[k] * fundamental_phase);
      if (oscillators_at_zero.empty()) continue;
      const std::complex<double> turned =
          oscillators_at_zero[k] * std::complex<double>(u[1 + 2 * i], u[2 + 2 * i]);
      u[1 + 2 * i] = turned.real();
      u[2 + 2 * i] = turned.imag();
    }
  }

  // K and C of the system, and the force on its masses, with the bends of `beyond`.
  typename S::Square stiffness_beyond(ContactMask beyond) const {
    typename S::Square with = K;
    bends.add_stiffness(beyond, with);
    return with;
  }
  typename S::Square damping_beyond(ContactMask beyond) const {
    typename S::Square with = C;
    bends.add_damping(beyond, with);
    return with;
  }
  typename S::VectorByOscillators force_beyond(ContactMask beyond) const {
    typename S::VectorByOscillators with = force;
    bends.add_force(beyond, bends.B, with);
    return with;
  }
  // M^-1 times it
  typename S::VectorByOscillators force_pull_beyond(ContactMask beyond) const {
    typename S::VectorByOscillators with = force_pull;
    bends.add_force(beyond, bends.MB, with);
    return with;
  }

  // (K q, M v, s / k): its product with another state is twice the energy norm's.
  template <class AnyState>
  typename S::State weighted_by_energy(const AnyState& z) const {
    const Eigen::Index n = masses();
    typename S::State weighted(states());
    weighted.head(n) = K * z.head(n);
    weighted.segment(n, n) = M * z.segment(n, n);
    if constexpr (S::kInternal != 0)
      weighted.tail(internal_forces()) = z.tail(internal_forces()).array() / internal_stiffness.array();
    return weighted;
  }

  // The energy norm of a state, sqrt((v^T M v + q^T K q + sum s^2 / k) / 2)  [sqrt(J)]. No two motions under
  // monotone laws ever move apart in it.
  template <class AnyState>
  double energy_norm(const AnyState& z) const {
    const Eigen::Index n = masses();
    const auto q = z.head(n);
    const auto v = z.segment(n, n);
    double energy = v.dot(M * v) + q.dot(K * q);
    if constexpr (S::kInternal != 0) {
      energy += (z.tail(internal_forces()).array().square() / internal_stiffness.array()).sum();
    }
    return std::sqrt(0.5 * energy);
  }
};

// The fastest rate [rad/s] at which a solution's Taylor coefficients can grow in the energy norm:
// rho = (gamma + sqrt(gamma^2 + 4 kappa)) / 2 with gamma, kappa the largest eigenvalues of M^-1 C and M^-1 K;
// with internal forces gamma + sqrt(kappa), gamma at least their largest rate and K with their springs.
// Contacts that stick only lower it (Courant-Fischer).
double fastest_rate(const mechanics::LinearSystem& system);

// Length of a step [s]: kStepRate over the fastest rate of system and forcing, the latter rounded up in
// powers of sqrt(2) of the former so that the step stays the same over a range of frequencies.
double step_length(double fastest_rate, double omega, int largest_order);

}  // namespace frahm::periodic
