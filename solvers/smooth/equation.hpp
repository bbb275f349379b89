#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/smooth/smooth_force.hpp"

namespace frahm::smooth {

// All values of the equation at one instant of a motion.
struct Instant {
  Eigen::VectorXd z, dz;       // state and its rate
  Eigen::VectorXd u, du;       // oscillators and their rate
  Eigen::VectorXd bent, rate;  // phi_j [N] and dphi_j/dt [N/s] of each term that is not linear
};

// Each term for a straight line, phi_j = force_j + slope_j x_j [N].
struct StraightTerms {
  Eigen::VectorXd force, slope;
};

// A steady state mean + Re sum_k harmonics_k e^{i order_k omega t}.
struct SteadyState {
  Eigen::VectorXd mean;        // size N
  Eigen::MatrixXcd harmonics;  // N x orders

  bool is_finite() const { return mean.allFinite() && harmonics.allFinite(); }
};

// Equation of motion of a network with smooth laws, as a first-order system in SI units:
//
//   z' = A z + B u(t) + sum_j g_j phi_j(x_j),   x_j = w_j^T z + r_j u(t),   g_j = (0, -M^-1 w_j, 0)
//
// x_j is the velocity across an element that rubs, and the displacement across a spring (smooth_force.hpp).
// z = (q [m], q' [m/s], s [N]): n displacements, n velocities, the forces of the Maxwell elements; size N.
// u(t) = (1, cos(order_1 omega t), sin(order_1 omega t), ...): the oscillators of the forcing; size O.
// Each element of a smooth law is a term of its own.
class Equation {
 public:
  // The oscillators and sizes of a network; nothing moves before set().
  explicit Equation(const mechanics::Assembly& assembly);  // must outlive the equation

  // Matrices, forces and forcing; both of the same values, but for the periods that the system takes for one.
  void set(const mechanics::LinearSystem& system, const mechanics::NetworkValues& values);

  Eigen::Index masses() const { return masses_; }
  Eigen::Index size() const { return size_; }
  Eigen::Index oscillators() const { return 1 + 2 * static_cast<Eigen::Index>(orders_.size()); }
  Eigen::Index terms() const { return static_cast<Eigen::Index>(elements_.size()); }
  // Whether a term is friction, which dissipates; of the others the energy comes back.
  bool rubs(Eigen::Index term) const;
  double omega() const { return omega_; }
  double period() const;  // [s]
  // For the lowest order of the forcing [rad/s].
  double lowest_rate() const { return omega_ * orders_.front(); }

  // z' at time t [s], counted from omega t = 0; and its derivative by z, N x N.
  void rates(double t, const Eigen::Ref<const Eigen::VectorXd>& z, Eigen::Ref<Eigen::VectorXd> dz);
  void jacobian(double t, const Eigen::Ref<const Eigen::VectorXd>& z, Eigen::Ref<Eigen::MatrixXd> J);
  // The whole instant at (t, z).
  void look(double t, const Eigen::Ref<const Eigen::VectorXd>& z, Instant& instant);

  // x_j of each term at (t, z) [m/s or m], and the friction limits F_j of arctan [N].
  const Eigen::VectorXd& arguments(double t, const Eigen::Ref<const Eigen::VectorXd>& z);
  const Eigen::VectorXd& limits() const { return limit_; }

  // The steady state of z' = A z + B u(t), and that with straight terms. Not finite where there is none.
  SteadyState linear_response() const;
  SteadyState linear_response(const StraightTerms& terms) const;
  Eigen::VectorXd at(double t, const SteadyState& state) const;

  // The tangents of friction at rest, relative to the mean velocity of supports; of other terms nothing.
  StraightTerms at_rest() const;
  // For friction in this motion: its mean, and the damper that takes as much energy of what moves about it.
  StraightTerms equivalent(const SteadyState& state) const;

  // The energy norm, sqrt((v^T M v + q^T K q + sum s^2/k) / 2) [sqrt(J)]; of a matrix that maps states, no
  // less than the largest factor by which it stretches that norm (its Frobenius norm); and the norm of the
  // static response to the amplitudes of the forcing.
  double energy_norm(const Eigen::VectorXd& z) const;
  double energy_norm_of_map(const Eigen::MatrixXd& map) const;
  double static_norm() const { return static_norm_; }
  // The scale of residuals and errors of a state z [sqrt(J)].
  double energy_scale(const Eigen::VectorXd& z) const { return std::max(energy_norm(z), static_norm_); }
  // Largest static displacement under the amplitudes of the forcing [m].
  double static_displacement() const { return static_displacement_; }
  // The largest displacement at which a term begins to matter compared with what is linear [m].
  double bent_displacement() const { return bent_displacement_; }
  // Scales of displacements, velocities and Maxwell forces for their errors: the largest values, and at least
  // a thousandth of the static ones.
  Eigen::VectorXd scale(double displacement, double velocity) const;

  // Of Forms: rows of a linear form on (z, u, phi).
  const Eigen::MatrixXd& A() const { return A_; }
  const Eigen::MatrixXd& B() const { return B_; }
  const Eigen::MatrixXd& G() const { return G_; }
  const std::vector<std::size_t>& elements() const { return elements_; }  // of the terms
  // Displacements, velocities and accelerations of the prescribed nodes, and the outside forces on the
  // masses, as rows on u(t).
  const Eigen::MatrixXd& motion() const { return motion_; }
  const Eigen::MatrixXd& motion_velocity() const { return motion_velocity_; }
  const Eigen::MatrixXd& motion_acceleration() const { return motion_acceleration_; }
  const Eigen::MatrixXd& applied_force() const { return applied_force_; }

 private:
  void set_linear_part(const mechanics::LinearSystem& system);
  void set_terms(const mechanics::LinearSystem& system, const mechanics::NetworkValues& values);
  void oscillate(double t);
  SteadyState steady_state(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) const;
  Eigen::MatrixXd rows_of(const Eigen::VectorXd& constant, const Eigen::MatrixXcd& harmonics) const;
  Eigen::MatrixXd differentiated(const Eigen::MatrixXd& rows) const;

  const mechanics::Assembly& assembly_;
  std::vector<int> orders_;
  std::vector<std::size_t> elements_;
  Eigen::Index masses_ = 0, size_ = 0;
  double omega_ = 0.0;
  Eigen::MatrixXd A_, B_, G_;
  Eigen::MatrixXd W_, support_;  // rows w_j^T on z, r_j on u
  Eigen::VectorXd limit_;        // F_j [N]
  std::vector<SmoothForce> forces_;
  Eigen::VectorXd internal_stiffness_;
  Eigen::MatrixXd energy_root_;  // R with R^T R = blockdiag(K, M, 1/k)
  Eigen::MatrixXd motion_, motion_velocity_, motion_acceleration_, applied_force_;
  double static_norm_ = 0.0, static_displacement_ = 0.0, bent_displacement_ = 0.0;
  Eigen::VectorXd u_, x_, phi_;  // workspace
};

}  // namespace frahm::smooth
