#include "solvers/flow/equations.hpp"

#include <algorithm>
#include <numbers>

#include "solvers/algebra/symmetric_modes.hpp"

namespace frahm::periodic {

double fastest_rate(const mechanics::LinearSystem& system) {
  const auto largest = [&](const Eigen::MatrixXd& matrix) {
    return std::max(0.0, algebra::symmetric_values(matrix, system.M).maxCoeff());
  };
  if (system.internal_forces() > 0) {
    const double gamma = std::max(largest(system.C), system.internal_rate.maxCoeff());
    return gamma + std::sqrt(largest(system.K + system.D * system.internal_stiffness.asDiagonal() *
                                                    system.D.transpose()));
  }
  const double gamma = largest(system.C), kappa = largest(system.K);
  return 0.5 * (gamma + std::sqrt(gamma * gamma + 4.0 * kappa));
}

double step_length(double fastest_rate, double omega, int largest_order) {
  const double forcing_rate = std::max(1, largest_order) * omega;
  double rate = fastest_rate;
  while (rate < forcing_rate) rate *= std::numbers::sqrt2;
  return kStepRate / rate;
}

}  // namespace frahm::periodic
