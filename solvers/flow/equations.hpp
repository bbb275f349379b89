#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "solvers/flow/sizes.hpp"
#include "solvers/flow/sparse_system.hpp"
#include "solvers/flow/step_bends.hpp"
#include "solvers/flow/step_free.hpp"
#include "solvers/flow/step_joints.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/recorded_columns.hpp"

namespace frahm::periodic {

// Rows with row * u(t) = Re(constant + sum_k harmonic_k e^{i phi_k}) + recorded * (r, r', ...):
// Re(f e^{i phi}) = Re f cos phi - Im f sin phi; each number of a record is counted in its own size.
template <class Rows>
void on_oscillators(const Eigen::VectorXd& constant, const Eigen::MatrixXcd& harmonic,
                    const Eigen::MatrixXd& recorded, const Eigen::VectorXd& size, Rows& rows) {
  const Eigen::Index first = 1 + 2 * harmonic.cols();
  rows.resize(constant.size(), first + size.size());
  rows.col(0) = constant;
  for (Eigen::Index k = 0; k < harmonic.cols(); ++k) {
    rows.col(1 + 2 * k) = harmonic.col(k).real();
    rows.col(2 + 2 * k) = -harmonic.col(k).imag();
  }
  for (Eigen::Index k = 0; k < size.size(); ++k) rows.col(first + k) = size[k] * recorded.col(k);
}

// The equation of motion with time counted in steps of length h, so that velocities are displacements a step:
//   (M/h^2) q'' + (C/h) q' + K q + D s = f(t) - W lambda,  s' = k (D^T q' + p^T y') - (rate h) s  (Maxwell)
// Energies and forces keep their units [J, N].
template <int N, int H>
struct StepEquations {
  using S = Sizes<N, H>;

  double step = 0.0;    // h [s]
  double period = 0.0;  // of the fundamental, in steps
  // K_inverse: of K with springs in the free directions that make them swing at 1 rad a step.
  typename S::Square M, C, K, M_inverse, K_inverse;
  typename S::Square M_root, K_root, M_root_inverse, K_root_inverse;  // upper Cholesky factors: M = R^T R
  // K_root: with the springs of K_inverse.
  bool has_free_masses = false;  // some directions of the masses are free
  StepFree free;
  typename S::VectorByOscillators force;          // f(t) = force * u(t) [N]
  typename S::VectorByOscillators force_pull;     // M^-1 force
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
  Eigen::MatrixXd internal_drive;                     // k p^T y'(t) [N a step], and what loads of joints add
  StepJoints joints;
  Eigen::VectorXd phase_rate;  // order_k omega h [rad a step], size H
  // For the records' numbers r, r', r'', r''' (mechanics/recorded_columns.hpp): the size in which each is
  // counted [SI]; the rate at which it changes per size of the next [1/step], 0 of r'''; their values at an
  // instant from which on they are polynomials, none before they are set; and omega t there [rad].
  Eigen::VectorXd recorded_size, recorded_rate, recorded_at;
  double recorded_phase = 0.0;
  // Where recorded supports take the masses, if all is slow: q_s = quasi_static u(t), n x oscillators, 0
  // columns where there are none. It is no faster than a record's cubic, so that what is bounded by rates is
  // the motion next to it, which supports that drift far away do not enlarge.
  Eigen::MatrixXd quasi_static, quasi_static_velocity;
  typename S::Contacts support_speed;  // what supports add to the sliding speed, next to q_s [m a step]
  StepBends<N, H> bends;
  bool monotone = true;          // LinearSystem::monotone
  SparseSystem sparse;           // of a large system
  SystemOf<float> sparse_rough;  // the same in single precision

  Eigen::Index masses() const { return M.rows(); }
  Eigen::Index contacts() const { return limit.size(); }
  // Whether Taylor series come from the equation itself (SparseSystem), not from tables of each
  // configuration.
  bool is_large() const { return !S::is_fixed && masses() >= large_from; }
  Eigen::Index large_from = 8;  // as fast both ways there, for an orbit of some dozens of steps
  // Whether contact j holds its velocity at zero while it sticks; otherwise its force is a state.
  bool holds(Eigen::Index j) const { return contains(holding, j); }
  Eigen::Index internal_forces() const { return internal_stiffness.size(); }
  Eigen::Index states() const { return 2 * masses() + internal_forces(); }
  Eigen::Index oscillators() const { return force.cols(); }
  Eigen::Index first_recorded() const { return 1 + 2 * phase_rate.size(); }  // among the oscillators

  // d/dt of row * u(t):  cos' = -rate sin, sin' = rate cos;  of a record r' is the next number.
  template <class Rows>
  void differentiate(const Rows& rows, Rows& result) const {
    result.col(0).setZero();
    for (Eigen::Index k = 0; k < phase_rate.size(); ++k) {
      result.col(1 + 2 * k) = phase_rate[k] * rows.col(2 + 2 * k);
      result.col(2 + 2 * k) = -phase_rate[k] * rows.col(1 + 2 * k);
    }
    if constexpr (!S::is_fixed) {
      if (first_recorded() < rows.cols()) result.col(first_recorded()).setZero();
      for (Eigen::Index k = first_recorded() + 1; k < rows.cols(); ++k)
        result.col(k) = recorded_rate[k - 1 - first_recorded()] * rows.col(k - 1);
    }
  }

  // The integral over t of the oscillating part of row * u(t), of zero mean; constants and records are left
  // out.
  Eigen::MatrixXd integrated(const Eigen::MatrixXd& rows) const {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows.rows(), rows.cols());
    for (Eigen::Index k = 0; k < phase_rate.size(); ++k) {
      result.col(1 + 2 * k) = -rows.col(2 + 2 * k) / phase_rate[k];
      result.col(2 + 2 * k) = rows.col(1 + 2 * k) / phase_rate[k];
    }
    return result;
  }

  // du/dt of the oscillators u [1/step].
  void oscillator_rates(const typename S::Oscillators& u, typename S::Oscillators& du) const {
    du.resize(u.size());
    du[0] = 0.0;
    for (Eigen::Index k = 0; k < phase_rate.size(); ++k) {
      du[1 + 2 * k] = -phase_rate[k] * u[2 + 2 * k];
      du[2 + 2 * k] = phase_rate[k] * u[1 + 2 * k];
    }
    if constexpr (!S::is_fixed) {
      const Eigen::Index numbers = recorded_rate.size();
      for (Eigen::Index k = 0; k < numbers; ++k)
        du[first_recorded() + k] = k + 1 < numbers ? recorded_rate[k] * u[first_recorded() + k + 1] : 0.0;
    }
  }

  // The numbers of the records `s` steps after `from`, in u:  r + r' s + r'' s^2/2 + r''' s^3/6 and its
  // derivatives.
  template <class Numbers>
  void move_records(double s, const Numbers& from, typename S::Oscillators& u) const {
    constexpr Eigen::Index count = mechanics::kRecordNumbers;
    for (Eigen::Index k = 0; k < from.size(); k += count) {
      const auto r = from.template segment<count>(k);
      const auto rate = s * recorded_rate.segment<count>(k);
      const double r2 = r[2] + rate[2] * r[3];
      const double r1 = r[1] + rate[1] * (r[2] + rate[2] / 2.0 * r[3]);
      const double r0 = r[0] + rate[0] * (r[1] + rate[1] / 2.0 * (r[2] + rate[2] / 3.0 * r[3]));
      u.template segment<count>(first_recorded() + k) << r0, r1, r2, r[3];
    }
  }

  void oscillators_at(double fundamental_phase, const std::vector<int>& orders,
                      typename S::Oscillators& u) const {
    u[0] = 1.0;
    for (std::size_t k = 0; k < orders.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      u[1 + 2 * i] = std::cos(orders[k] * fundamental_phase);
      u[2 + 2 * i] = std::sin(orders[k] * fundamental_phase);
    }
    if constexpr (!S::is_fixed) {
      u.tail(u.size() - first_recorded()).setZero();
      move_records((fundamental_phase - recorded_phase) / (2.0 * M_PI) * period, recorded_at, u);
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
    double energy = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) energy += v[i] * M.col(i).dot(v) + q[i] * K.col(i).dot(q);
    if constexpr (S::kInternal != 0) {
      energy += (z.tail(internal_forces()).array().square() / internal_stiffness.array()).sum();
    }
    return std::sqrt(0.5 * std::max(energy, 0.0));  // of free masses that are far away, below by rounding
  }
};

// The fastest rate [rad/s] at which a solution's Taylor coefficients can grow in the energy norm:
// rho = (gamma + sqrt(gamma^2 + 4 kappa)) / 2 with gamma, kappa the largest eigenvalues of M^-1 C and M^-1 K;
// with internal forces gamma + sqrt(kappa), gamma at least their largest rate and K with their springs.
// Contacts that stick only lower it (Courant-Fischer).
double fastest_rate(const mechanics::LinearSystem& system);

// Length of a step [s]: kStepRate over the fastest rate of system and forcing, the latter rounded up in
// powers of sqrt(2) of the former so that the step stays the same over a range of frequencies; of the latter
// alone where nothing in the system has a rate.
double step_length(double fastest_rate, double omega, int largest_order);

// The longest step no longer than `step` of which `interval` has a whole number; step, where there is no
// interval.
double step_within(double interval, double step);

}  // namespace frahm::periodic
