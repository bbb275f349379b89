#include "solvers/periodic/fundamental_response.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

namespace frahm::periodic {

Eigen::Index reference_place(const mechanics::LinearSystem& system) {
  return std::find(system.orders.begin(), system.orders.end(), system.reference_order) -
         system.orders.begin();
}

Eigen::VectorXd static_displacement(const mechanics::LinearSystem& system) {
  const Eigen::Index place = reference_place(system);
  Eigen::VectorXcd force = system.applied_force.col(place);
  if (system.motion.rows() > 0) force -= system.K_support * system.motion.col(place);
  const Eigen::LLT<Eigen::MatrixXd> stiffness(system.K);
  Eigen::VectorXcd displacement(force.size());
  displacement.real() = stiffness.solve(force.real());
  displacement.imag() = stiffness.solve(force.imag());
  return displacement.cwiseAbs();
}

double support_amplitude(const mechanics::LinearSystem& system) {
  const Eigen::VectorXd amplitude = system.motion.col(reference_place(system)).cwiseAbs();
  return (amplitude.array() > 0.0).count() == 1 ? amplitude.maxCoeff() : 0.0;
}

double force_transmissibility(const mechanics::LinearSystem& system, const Eigen::VectorXcd& X) {
  const std::complex<double> applied = system.applied_force.col(reference_place(system)).sum();
  const double rate = system.reference_order * system.omega;
  // What acts on the supports is P - sum_i m_i x_i'', at the reference order P + (n omega)^2 sum_i m_i X_i.
  const std::complex<double> on_supports =
      applied + rate * rate * system.mass.cast<std::complex<double>>().dot(X);
  return ratio(std::abs(on_supports), std::abs(applied));
}

double ratio(double a, double b) {
  return b > 0.0 ? a / b : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace frahm::periodic
