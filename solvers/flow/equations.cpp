#include "solvers/flow/equations.hpp"

#include <algorithm>
#include <numbers>

#include "solvers/algebra/symmetric_modes.hpp"

namespace frahm::periodic {

double fastest_rate(const mechanics::LinearSystem& system) {
  const auto largest = [&](const Eigen::MatrixXd& matrix) {
    return std::max(0.0, algebra::symmetric_values(matrix, system.M).maxCoeff());
  };
  // Beyond all bends that stiffen or damp.
  const mechanics::Bends& bends = system.bends;
  Eigen::MatrixXd K = system.K, C = system.C;
  for (Eigen::Index j = 0; j < bends.count(); ++j) {
    K += std::max(0.0, bends.stiffness[j]) * bends.W.col(j) * bends.W.col(j).transpose();
    C += std::max(0.0, bends.damping[j]) * bends.W.col(j) * bends.W.col(j).transpose();
  }
  if (system.internal_forces() > 0) {
    const double gamma = std::max(largest(C), system.internal_rate.maxCoeff());
    return gamma +
           std::sqrt(largest(K + system.D * system.internal_stiffness.asDiagonal() * system.D.transpose()));
  }
  const double gamma = largest(C), kappa = largest(K);
  return 0.5 * (gamma + std::sqrt(gamma * gamma + 4.0 * kappa));
}

double step_length(double fastest_rate, double omega, int largest_order) {
  const double forcing_rate = std::max(1, largest_order) * omega;
  double rate = fastest_rate > 0.0 ? fastest_rate : forcing_rate;
  while (rate < forcing_rate) rate *= std::numbers::sqrt2;
  return kStepRate / rate;
}

double step_within(double interval, double step) {
  return interval > 0.0 ? interval / std::ceil(interval / step * (1.0 - 1e-12)) : step;
}

}  // namespace frahm::periodic
