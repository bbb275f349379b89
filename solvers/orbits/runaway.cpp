#include "solvers/orbits/runaway.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "solvers/events/box_minimum.hpp"
#include "solvers/mechanics/free_directions.hpp"

namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// What resists a constant velocity with a force between two limits, its direction a column of W.
struct Limited {
  MatrixXd W;
  VectorXd least, most;

  void add(const VectorXd& w, double from, double to) {
    W.conservativeResize(w.size(), W.cols() + 1);
    W.rightCols(1) = w;
    least.conservativeResize(W.cols());
    most.conservativeResize(W.cols());
    least.tail(1)[0] = from;
    most.tail(1)[0] = to;
  }
};

// A damper with a table, beyond all its points: on each side c v + sum c_b (v - D_b) goes on, or ends level.
struct Table {
  double damping = 0.0, force = 0.0, largest = 0.0;  // of one side
  double limit() const { return std::abs(damping) > 1e-12 * largest ? HUGE_VAL : force; }
};

// Contacts and level tables; more: of each element, what its table adds to its damping where it does not end
// level on both sides, and less its own damping where it does on one.
Limited limited_forces(const mechanics::LinearSystem& system, std::vector<double>& more) {
  Limited result{MatrixXd(system.masses(), 0), VectorXd(0), VectorXd(0)};
  for (Index j = 0; j < system.contacts(); ++j)
    result.add(system.W.col(j), -system.static_limit[j], system.static_limit[j]);
  const mechanics::Bends& bends = system.bends;
  for (Index first = 0, next = 0; first < bends.count(); first = next) {
    const std::size_t element = bends.element[static_cast<std::size_t>(first)];
    const double own = system.coefficients[element].damping;
    Table sides[2] = {{own, 0.0, own}, {own, 0.0, own}};
    bool of_velocity = true;
    for (; next < bends.count() && bends.element[static_cast<std::size_t>(next)] == element; ++next) {
      of_velocity = of_velocity && bends.law[static_cast<std::size_t>(next)]->of_velocity;
      Table& side = sides[bends.side[static_cast<std::size_t>(next)] > 0.0 ? 0 : 1];
      side.damping += bends.damping[next];
      side.force -= bends.damping[next] * bends.place[next];
      side.largest = std::max(side.largest, std::abs(bends.damping[next]));
    }
    if (!of_velocity) continue;
    const double ahead = sides[0].limit(), behind = sides[1].limit();
    more[element] = std::isinf(ahead) && std::isinf(behind) ? sides[0].damping - own : -own;
    if (more[element] == -own)
      result.add(bends.side[static_cast<std::size_t>(first)] * bends.W.col(first), -behind, ahead);
  }
  return result;
}

// The free directions along which neither dampers nor stops act.
MatrixXd undamped_directions(const mechanics::Assembly& assembly, const mechanics::LinearSystem& system,
                             const std::vector<double>& more) {
  const MatrixXd& R = system.free_directions;
  const MatrixXd damped =
      mechanics::strained_along(mechanics::damped_combinations(assembly, system, more).transpose(), R);
  const MatrixXd bent = mechanics::strained_along(system.bends.W, R);
  MatrixXd rows(damped.rows() + bent.rows(), R.cols());
  rows << damped, bent;
  for (Index j = 0; j < bent.rows(); ++j) {
    if (system.bends.law[static_cast<std::size_t>(j)]->of_velocity) rows.row(damped.rows() + j).setZero();
  }
  return R * mechanics::unstrained(rows);
}

// The direction that gives the load the most over what holds it, as it moves masses by up to 1.
std::string told(const mechanics::Network& network, const VectorXd& along, double load, double held) {
  constexpr double kShare = 1e-6;
  std::string names;
  for (Index i = 0; i < along.size(); ++i) {
    if (std::abs(along[i]) < kShare) continue;
    names += (names.empty() ? "\"" : ", \"") + network.masses[static_cast<std::size_t>(i)] + "\"";
  }
  char text[200];
  std::snprintf(
      text, sizeof text,
      " without limit: a constant load of %.6g, and friction that holds at most %.6g; no spring and "
      "no damper acts there",
      load, held);
  return "velocities grow of " + names + text;
}

}  // namespace

// The point of all R_c^T W lambda closest to R_c^T f_0 leaves a direction in which the load is the larger.
std::string runaway(const mechanics::Assembly& assembly, const mechanics::LinearSystem& system) {
  constexpr double kRounding = 1e-12;
  if (system.free_directions.cols() == 0) return "";
  std::vector<double> more(system.coefficients.size(), 0.0);
  const Limited limited = limited_forces(system, more);
  const MatrixXd R = undamped_directions(assembly, system, more);
  if (R.cols() == 0) return "";
  const VectorXd drive = R.transpose() * system.constant_force;
  const double size = (R.cwiseAbs().transpose() * system.constant_force.cwiseAbs()).maxCoeff();
  if (drive.norm() <= kRounding * size) return "";
  const MatrixXd A = mechanics::strained_along(limited.W, R).transpose();
  VectorXd left = drive;
  if (A.cols() > 0) {
    const BoxMinimum held = box_minimum(A.transpose() * A, A.transpose() * drive, limited.least, limited.most,
                                        VectorXd::Ones(A.cols()));
    left -= A * held.lambda;
    if (left.norm() <= kRounding * (size + (A.cwiseAbs() * held.lambda.cwiseAbs()).maxCoeff())) return "";
  }
  VectorXd along = R * left;
  along /= along.cwiseAbs().maxCoeff();
  double friction = 0.0;
  for (Index j = 0; j < limited.W.cols(); ++j) {
    const double rate = limited.W.col(j).dot(along);
    if (rate != 0.0) friction += rate > 0.0 ? rate * limited.most[j] : rate * limited.least[j];
  }
  return told(assembly.network(), along, along.dot(system.constant_force), friction);
}

}  // namespace frahm::periodic
