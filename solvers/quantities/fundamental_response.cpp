#include "solvers/quantities/fundamental_response.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "solvers/algebra/no_value.hpp"

namespace frahm::periodic {
namespace {

Eigen::VectorXcd static_load(const mechanics::LinearSystem& system) {
  const Eigen::Index column = reference_column(system);
  Eigen::VectorXcd load = system.applied_force.col(column);
  if (system.motion.rows() > 0) load -= system.K_support * system.motion.col(column);
  if (system.joints.any()) load += system.joints.B.transpose() * system.joints.load.col(column);
  return load;
}

// x = B q + B_support Y + A P of the joints at rest.
Eigen::VectorXcd joints_at_rest(const mechanics::LinearSystem& system, const Eigen::VectorXcd& q) {
  const mechanics::Joints& joints = system.joints;
  const Eigen::Index column = reference_column(system);
  Eigen::VectorXcd x = joints.B * q + joints.A * joints.load.col(column);
  if (system.motion.rows() > 0) x += joints.B_support * system.motion.col(column);
  return x;
}

// Its derivative.
Eigen::VectorXcd joints_at_rest_derivative(const mechanics::LinearSystem& system,
                                           const mechanics::LinearSystem& by, const Eigen::VectorXcd& q,
                                           const Eigen::VectorXcd& q_by) {
  const mechanics::Joints &joints = system.joints, &d = by.joints;
  const Eigen::Index column = reference_column(system);
  Eigen::VectorXcd x =
      joints.B * q_by + d.B * q + joints.A * d.load.col(column) + d.A * joints.load.col(column);
  if (system.motion.rows() > 0)
    x += joints.B_support * by.motion.col(column) + d.B_support * system.motion.col(column);
  return x;
}

Eigen::VectorXcd static_solution(const mechanics::LinearSystem& system, const Eigen::VectorXcd& load) {
  const Eigen::LLT<Eigen::MatrixXd> stiffness(system.K);
  Eigen::VectorXcd displacement(load.size());
  displacement.real() = stiffness.solve(load.real());
  displacement.imag() = stiffness.solve(load.imag());
  return displacement;
}

// The sum of a vector's entries by their weights; dot() would take a conjugate.
std::complex<double> sum(const Eigen::VectorXd& weights, const Eigen::VectorXcd& of) {
  return weights.cwiseProduct(of).sum();
}

// The inertia forces that the supports feel, over (n omega)^2.
std::complex<double> inertia_felt(const mechanics::LinearSystem& system, const Eigen::VectorXcd& X,
                                  const Eigen::VectorXcd& Y) {
  return sum(system.felt_inertia.transpose(), X) + sum(system.felt_inertia_support.transpose(), Y);
}

// w^T q + p^T Y + j^T x; zero where the terms cancel each other but for rounding.
std::complex<double> along(const mechanics::Incidence& at, const Eigen::VectorXcd& q,
                           const Eigen::VectorXcd& Y, const Eigen::VectorXcd& x) {
  constexpr double kRounding = 1e-13;
  std::complex<double> sum = 0.0;
  double size = 0.0;
  const auto add = [&](const Eigen::VectorXd& factors, const Eigen::VectorXcd& amplitudes) {
    for (Eigen::Index i = 0; i < factors.size(); ++i) {
      if (factors[i] == 0.0) continue;
      sum += factors[i] * amplitudes[i];
      size += std::abs(factors[i] * amplitudes[i]);
    }
  };
  add(at.w, q);
  add(at.p, Y);
  if (at.has_joint()) add(at.j, x);
  return std::abs(sum) > kRounding * size ? sum : 0.0;
}

}  // namespace

Eigen::Index reference_column(const mechanics::LinearSystem& system) {
  return std::find(system.orders.begin(), system.orders.end(), system.reference_order) -
         system.orders.begin();
}

// Free masses have none, which counts as 0.
double static_displacement(const mechanics::LinearSystem& system, const mechanics::Incidence& at) {
  if (system.free_directions.cols() > 0) return 0.0;
  const Eigen::VectorXcd q = static_solution(system, static_load(system));
  const Eigen::VectorXcd x = at.has_joint() ? joints_at_rest(system, q) : Eigen::VectorXcd();
  return std::abs(along(at, q, system.motion.col(reference_column(system)), x));
}

// K dq = d(f - K_support Y) - dK q
double static_displacement_derivative(const mechanics::LinearSystem& system,
                                      const mechanics::LinearSystem& by, const mechanics::Incidence& at) {
  const Eigen::Index column = reference_column(system);
  const Eigen::VectorXcd q = static_solution(system, static_load(system));
  Eigen::VectorXcd load = by.applied_force.col(column) - by.K * q;
  if (system.motion.rows() > 0)
    load -= by.K_support * system.motion.col(column) + system.K_support * by.motion.col(column);
  if (system.joints.any())
    load += system.joints.B.transpose() * by.joints.load.col(column) +
            by.joints.B.transpose() * system.joints.load.col(column);
  const Eigen::VectorXcd q_by = static_solution(system, load);
  Eigen::VectorXcd x, x_by;
  if (at.has_joint()) {
    x = joints_at_rest(system, q);
    x_by = joints_at_rest_derivative(system, by, q, q_by);
  }
  return modulus_derivative(along(at, q, system.motion.col(column), x),
                            along(at, q_by, by.motion.col(column), x_by));
}

double support_amplitude(const mechanics::LinearSystem& system) {
  const Eigen::VectorXd amplitude = system.motion.col(reference_column(system)).cwiseAbs();
  return (amplitude.array() > 0.0).count() == 1 ? amplitude.maxCoeff() : 0.0;
}

double support_amplitude_derivative(const mechanics::LinearSystem& system,
                                    const mechanics::LinearSystem& by) {
  const Eigen::Index column = reference_column(system);
  Eigen::Index support = 0;
  system.motion.col(column).cwiseAbs().maxCoeff(&support);
  return modulus_derivative(system.motion(support, column), by.motion(support, column));
}

// c^T (P - M q'') and so on (SupportForce), at the reference order with q'' = -(n omega)^2 X.
double force_transmissibility(const mechanics::LinearSystem& system, const Eigen::VectorXcd& X) {
  const Eigen::Index column = reference_column(system);
  const Eigen::VectorXcd force = system.applied_force.col(column);
  const double rate = system.reference_order * system.omega;
  std::complex<double> on_supports =
      sum(system.support_force.c, force) + rate * rate * inertia_felt(system, X, system.motion.col(column));
  std::complex<double> applied = sum(system.support_force.counted, force);
  if (system.joints.any()) {
    on_supports += sum(system.support_force.joint_c, system.joints.load.col(column));
    applied += sum(system.support_force.joint_counted, system.joints.load.col(column));
  }
  return ratio(std::abs(on_supports), std::abs(applied));
}

double force_transmissibility_derivative(const mechanics::LinearSystem& system,
                                         const mechanics::LinearSystem& by, const Eigen::VectorXcd& X,
                                         const Eigen::VectorXcd& X_by) {
  const Eigen::Index column = reference_column(system);
  const double n = system.reference_order, rate = n * system.omega;
  const auto& [counted, c, excess, joint_counted, joint_c] = system.support_force;
  const Eigen::VectorXcd force = system.applied_force.col(column), force_by = by.applied_force.col(column);
  const Eigen::VectorXcd Y = system.motion.col(column), Y_by = by.motion.col(column);
  const std::complex<double> moved = inertia_felt(system, X, Y);
  const std::complex<double> moved_by = inertia_felt(system, X_by, Y_by) + inertia_felt(by, X, Y);
  std::complex<double> applied = sum(counted, force), applied_by = sum(counted, force_by);
  std::complex<double> on_supports = sum(c, force) + rate * rate * moved;
  std::complex<double> on_supports_by =
      sum(c, force_by) + rate * rate * moved_by + 2.0 * rate * n * by.omega * moved;
  if (system.joints.any()) {
    const Eigen::VectorXcd load = system.joints.load.col(column), load_by = by.joints.load.col(column);
    applied += sum(joint_counted, load);
    applied_by += sum(joint_counted, load_by);
    on_supports += sum(joint_c, load);
    on_supports_by += sum(joint_c, load_by);
  }
  const double above = std::abs(on_supports), below = std::abs(applied);
  return modulus_derivative(on_supports, on_supports_by) / below -
         above / (below * below) * modulus_derivative(applied, applied_by);
}

// d|z| = Re(conj(z) dz) / |z|
double modulus_derivative(std::complex<double> z, std::complex<double> z_by) {
  return ratio((std::conj(z) * z_by).real(), std::abs(z));
}

double ratio(double a, double b) {
  return b > 0.0 ? a / b : kNone;
}

}  // namespace frahm::periodic
