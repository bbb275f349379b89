#include "solvers/mechanics/undamped_resonance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/algebra/symmetric_modes.hpp"
#include "solvers/mechanics/free_directions.hpp"

namespace frahm::periodic {
namespace {

// What is left of the tables of dampers at velocities beyond all their points, which are straight from there
// on: damping, or the friction of a table that is level on both sides.
struct BeyondTables {
  Eigen::MatrixXd C;      // of the whole system [N s/m]
  Eigen::MatrixXd W;      // directions of the level ones, n x their number
  Eigen::VectorXd limit;  // and their forces, the mean of both sides [N]
};

// Stops and tables of springs change the frequency as the motion grows.
bool bends_over_velocity(const mechanics::LinearSystem& system) {
  return std::ranges::all_of(system.bends.law, [](const laws::Bend* law) { return law->of_velocity; });
}

BeyondTables beyond_tables(const mechanics::LinearSystem& system) {
  const mechanics::Bends& bends = system.bends;
  const Eigen::Index n = system.masses(), count = bends.count();
  BeyondTables beyond{system.C, Eigen::MatrixXd(n, 0), Eigen::VectorXd(0)};
  if (!bends_over_velocity(system)) return beyond;
  for (Eigen::Index first = 0, next = 0; first < count; first = next) {
    const std::size_t element = bends.element[static_cast<std::size_t>(first)];
    const double damping = system.coefficients[element].damping;
    // Halves of both sides: of a period half belongs to each.
    double change = 0.0, force = 0.0, largest = damping;
    for (; next < count && bends.element[static_cast<std::size_t>(next)] == element; ++next) {
      change += 0.5 * bends.damping[next];
      force -= 0.5 * bends.damping[next] * bends.place[next];
      largest = std::max(largest, std::abs(bends.damping[next]));
    }
    const Eigen::VectorXd w = bends.W.col(first);
    constexpr double kLevel = 1e-12;
    const bool is_level = std::abs(damping + change) <= kLevel * largest;
    beyond.C.noalias() += (is_level ? -damping : change) * w * w.transpose();
    if (!is_level) continue;
    beyond.W.conservativeResize(n, beyond.W.cols() + 1);
    beyond.W.rightCols(1) = w;
    beyond.limit.conservativeResize(beyond.W.cols());
    beyond.limit.tail(1)[0] = force;
  }
  return beyond;
}

// Whether the excitation of this mode shape (phi^T M phi = 1) at this order exceeds what contacts of these
// limits can take.
bool outgrows_friction(const mechanics::LinearSystem& system, const Eigen::VectorXd& limit,
                       const BeyondTables& beyond, const Eigen::VectorXd& shape, Eigen::Index order) {
  const double drive = std::abs(std::complex<double>((shape.transpose() * system.force.col(order))(0)));
  const double force_size = system.force.col(order).norm() * shape.norm();
  if (drive <= 1e-14 * force_size) return false;
  const double friction = limit.dot((system.W.transpose() * shape).cwiseAbs()) +
                          beyond.limit.dot((beyond.W.transpose() * shape).cwiseAbs());
  return std::numbers::pi * drive >= 4.0 * friction;
}

}  // namespace

std::vector<UndampedMode> undamped_modes(const mechanics::LinearSystem& system) {
  std::vector<UndampedMode> result;
  const Eigen::Index n = system.masses();
  // A strained Maxwell element dissipates, as its damper would. A slider in series with a spring dissipates
  // by its friction.
  const Eigen::VectorXd dampers =
      (system.internal_rate.array() > 0.0)
          .select(system.internal_stiffness.cwiseQuotient(system.internal_rate), 0.0);
  const Eigen::MatrixXd C = beyond_tables(system).C + system.D * dampers.asDiagonal() * system.D.transpose();
  const Eigen::LLT<Eigen::MatrixXd> damped(C);
  const double scale = C.cwiseAbs().maxCoeff();
  if (damped.info() == Eigen::Success && damped.matrixLLT().diagonal().minCoeff() > 1e-7 * std::sqrt(scale))
    return result;

  const algebra::SymmetricModes modes = mechanics::undamped_modes_of(system);
  const Eigen::VectorXd& squares = modes.values;
  for (Eigen::Index first = system.free_directions.cols(); first < n;) {
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

namespace {

bool is_driven_harder(const mechanics::LinearSystem& system, const std::vector<UndampedMode>& modes,
                      const Eigen::VectorXd& limit) {
  if (modes.empty() || !bends_over_velocity(system)) return false;
  const BeyondTables beyond = beyond_tables(system);
  for (std::size_t order = 0; order < system.orders.size(); ++order) {
    const auto column = static_cast<Eigen::Index>(order);
    const double frequency = system.orders[order] * system.omega;
    // If several modes at this frequency are undamped, the forcing selects the combinations that it drives.
    Eigen::VectorXd in_phase = Eigen::VectorXd::Zero(system.masses()), in_quadrature = in_phase;
    for (const UndampedMode& mode : modes) {
      if (std::abs(frequency - mode.frequency) > 1e-12 * mode.frequency) continue;
      if (outgrows_friction(system, limit, beyond, mode.shape, column)) return true;
      in_phase += mode.shape * mode.shape.dot(system.force.col(column).real());
      in_quadrature += mode.shape * mode.shape.dot(system.force.col(column).imag());
    }
    if (in_phase.norm() > 0.0 && outgrows_friction(system, limit, beyond, in_phase, column)) return true;
    if (in_quadrature.norm() > 0.0 && outgrows_friction(system, limit, beyond, in_quadrature, column))
      return true;
  }
  return false;
}

}  // namespace

bool is_unbounded(const mechanics::LinearSystem& system, const std::vector<UndampedMode>& modes) {
  return is_driven_harder(system, modes, system.limit);
}

bool is_unbounded_even_held(const mechanics::LinearSystem& system, const std::vector<UndampedMode>& modes) {
  return is_driven_harder(system, modes, system.static_limit);
}

}  // namespace frahm::periodic
