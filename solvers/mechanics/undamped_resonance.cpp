#include "solvers/mechanics/undamped_resonance.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "solvers/algebra/symmetric_modes.hpp"

namespace frahm::periodic {
namespace {

// Whether the excitation of this mode shape (phi^T M phi = 1) at this order exceeds what friction can take.
bool outgrows_friction(const mechanics::LinearSystem& system, const Eigen::VectorXd& shape,
                       Eigen::Index order) {
  const double drive = std::abs(std::complex<double>((shape.transpose() * system.force.col(order))(0)));
  const double force_size = system.force.col(order).norm() * shape.norm();
  if (drive <= 1e-14 * force_size) return false;
  const double friction = (system.limit.array() * (system.W.transpose() * shape).array().abs()).sum();
  return std::numbers::pi * drive >= 4.0 * friction;
}

}  // namespace

std::vector<UndampedMode> undamped_modes(const mechanics::LinearSystem& system) {
  std::vector<UndampedMode> result;
  const Eigen::Index n = system.masses();
  // A strained Maxwell element dissipates, as its damper would. A slider behind a spring dissipates by its
  // friction.
  const Eigen::VectorXd dampers =
      (system.internal_rate.array() > 0.0)
          .select(system.internal_stiffness.cwiseQuotient(system.internal_rate), 0.0);
  const Eigen::MatrixXd C = system.C + system.D * dampers.asDiagonal() * system.D.transpose();
  const Eigen::LLT<Eigen::MatrixXd> damped(C);
  const double scale = C.cwiseAbs().maxCoeff();
  if (damped.info() == Eigen::Success && damped.matrixLLT().diagonal().minCoeff() > 1e-7 * std::sqrt(scale))
    return result;

  const algebra::SymmetricModes modes = algebra::symmetric_modes(system.K, system.M);
  const Eigen::VectorXd& squares = modes.values;
  for (Eigen::Index first = 0; first < n;) {
    Eigen::Index last = first + 1;
    while (last < n && squares[last] - squares[first] <= 1e-12 * squares[last]) ++last;
    const Eigen::MatrixXd shapes = modes.vectors.middleCols(first, last - first);
    const Eigen::MatrixXd loss = shapes.transpose() * C * shapes;  // positive semidefinite
    const algebra::SymmetricModes losses = algebra::symmetric_modes(loss);
    const double frequency = std::sqrt(squares[first]);
    for (Eigen::Index k = 0; k < last - first; ++k) {
      // Damping ratios below 1e-14 are rounding.
      if (losses.values[k] <= 2e-14 * frequency) {
        result.push_back({frequency, shapes * losses.vectors.col(k)});
      }
    }
    first = last;
  }
  return result;
}

bool is_unbounded(const mechanics::LinearSystem& system, const std::vector<UndampedMode>& modes) {
  for (std::size_t order = 0; order < system.orders.size(); ++order) {
    const auto column = static_cast<Eigen::Index>(order);
    const double frequency = system.orders[order] * system.omega;
    // If several modes at this frequency are undamped, the forcing selects the combinations that it drives.
    Eigen::VectorXd in_phase = Eigen::VectorXd::Zero(system.masses()), in_quadrature = in_phase;
    for (const UndampedMode& mode : modes) {
      if (std::abs(frequency - mode.frequency) > 1e-12 * mode.frequency) continue;
      if (outgrows_friction(system, mode.shape, column)) return true;
      in_phase += mode.shape * mode.shape.dot(system.force.col(column).real());
      in_quadrature += mode.shape * mode.shape.dot(system.force.col(column).imag());
    }
    if (in_phase.norm() > 0.0 && outgrows_friction(system, in_phase, column)) return true;
    if (in_quadrature.norm() > 0.0 && outgrows_friction(system, in_quadrature, column)) return true;
  }
  return false;
}

}  // namespace frahm::periodic
