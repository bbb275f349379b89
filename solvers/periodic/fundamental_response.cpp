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

double ratio(double a, double b) {
  return b > 0.0 ? a / b : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace frahm::periodic
