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
  return load;
}

Eigen::VectorXcd static_solution(const mechanics::LinearSystem& system, const Eigen::VectorXcd& load) {
  const Eigen::LLT<Eigen::MatrixXd> stiffness(system.K);
  Eigen::VectorXcd displacement(load.size());
  displacement.real() = stiffness.solve(load.real());
  displacement.imag() = stiffness.solve(load.imag());
  return displacement;
}

}  // namespace

Eigen::Index reference_column(const mechanics::LinearSystem& system) {
  return std::find(system.orders.begin(), system.orders.end(), system.reference_order) -
         system.orders.begin();
}

Eigen::VectorXd static_displacement(const mechanics::LinearSystem& system) {
  return static_solution(system, static_load(system)).cwiseAbs();
}

// K dx = d(f - K_support Y) - dK x
Eigen::VectorXd static_displacement_derivative(const mechanics::LinearSystem& system,
                                               const mechanics::LinearSystem& by) {
  const Eigen::Index column = reference_column(system);
  const Eigen::VectorXcd x = static_solution(system, static_load(system));
  Eigen::VectorXcd load = by.applied_force.col(column) - by.K * x;
  if (system.motion.rows() > 0)
    load -= by.K_support * system.motion.col(column) + system.K_support * by.motion.col(column);
  const Eigen::VectorXcd x_by = static_solution(system, load);
  Eigen::VectorXd result(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) result[i] = modulus_derivative(x[i], x_by[i]);
  return result;
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

double force_transmissibility(const mechanics::LinearSystem& system, const Eigen::VectorXcd& X) {
  const std::complex<double> applied = system.applied_force.col(reference_column(system)).sum();
  const double rate = system.reference_order * system.omega;
  // What acts on the supports is P - sum_i m_i x_i'', at the reference order P + (n omega)^2 sum_i m_i X_i;
  // with matrices sum_ij m_ij X_j, as of displacements in one direction.
  const std::complex<double> on_supports = applied + rate * rate * (system.mass * X).sum();
  return ratio(std::abs(on_supports), std::abs(applied));
}

double force_transmissibility_derivative(const mechanics::LinearSystem& system,
                                         const mechanics::LinearSystem& by, const Eigen::VectorXcd& X,
                                         const Eigen::VectorXcd& X_by) {
  const Eigen::Index column = reference_column(system);
  const std::complex<double> applied = system.applied_force.col(column).sum();
  const std::complex<double> applied_by = by.applied_force.col(column).sum();
  const double n = system.reference_order, rate = n * system.omega;
  const std::complex<double> moved = (system.mass * X).sum();
  const std::complex<double> moved_by = (system.mass * X_by).sum() + (by.mass * X).sum();
  const std::complex<double> on_supports = applied + rate * rate * moved;
  const std::complex<double> on_supports_by =
      applied_by + rate * rate * moved_by + 2.0 * rate * n * by.omega * moved;
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
