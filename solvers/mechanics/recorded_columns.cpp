#include "solvers/mechanics/recorded_columns.hpp"

#include <cmath>

namespace frahm::mechanics {
namespace {

// The first column of each recorded excitation; -1 of the others.
std::vector<Eigen::Index> first_columns(const Network& network, Eigen::Index& columns) {
  std::vector<Eigen::Index> first;
  columns = 0;
  for (const Excitation& excitation : network.excitations) {
    first.push_back(is_recorded(excitation.kind) ? columns : -1);
    if (is_recorded(excitation.kind)) columns += kRecordNumbers;
  }
  return first;
}

void resize(const Network& network, Eigen::Index columns, LinearSystem& system) {
  const auto n = static_cast<Eigen::Index>(network.masses.size());
  const auto joints = static_cast<Eigen::Index>(network.joints.size());
  const auto p = static_cast<Eigen::Index>(network.prescribed.size());
  system.recorded_force.setZero(n, columns);
  system.recorded_applied_force.setZero(n, columns);
  system.recorded_motion.setZero(p, columns);
  system.joints.recorded_load.setZero(joints, columns);
}

// Where a recorded force acts: on a mass, or on a joint.
double& recorded_load(const Network& network, Eigen::Index node, Eigen::Index column, LinearSystem& system) {
  const auto n = static_cast<Eigen::Index>(network.masses.size());
  return node < n ? system.recorded_applied_force(node, column)
                  : system.joints.recorded_load(node - n, column);
}

// A cos(phase), what multiplies a record.
double factor(const ExcitationValue& value) {
  return value.amplitude * std::cos(value.phase);
}

// d [A cos phase]
double factor_derivative(const ExcitationValue& value, const ExcitationValue& by) {
  return by.amplitude * std::cos(value.phase) - value.amplitude * std::sin(value.phase) * by.phase;
}

// What a support that moves by a r(t) exerts on the masses: -(K_s y + C_s y' + M_s y''),  y = a r
void add_support_forces(const LinearSystem& matrices, double a, Eigen::Index node, Eigen::Index first,
                        Eigen::MatrixXd& force) {
  force.col(first) -= a * matrices.K_support.col(node);
  force.col(first + 1) -= a * matrices.C_support.col(node);
  force.col(first + 2) -= a * matrices.M_support.col(node);
}

}  // namespace

void set_recorded(const Network& network, const NetworkValues& values, LinearSystem& system) {
  Eigen::Index columns = 0;
  const std::vector<Eigen::Index> first = first_columns(network, columns);
  resize(network, columns, system);
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k] < 0) continue;
    const auto node = static_cast<Eigen::Index>(network.excitations[k].node);
    const double a = factor(values.excitation[k]);
    if (network.excitations[k].kind == ExcitationKind::recorded_force) {
      recorded_load(network, node, first[k], system) += a;
      continue;
    }
    system.recorded_motion(node, first[k]) += a;
    add_support_forces(system, a, node, first[k], system.recorded_force);
  }
  system.recorded_force += system.recorded_applied_force;
}

// d(K_s a) = dK_s a + K_s da, and so on.
void differentiate_recorded(const Network& network, const NetworkValues& values,
                            const NetworkValues& direction, const LinearSystem& system, LinearSystem& d) {
  Eigen::Index columns = 0;
  const std::vector<Eigen::Index> first = first_columns(network, columns);
  resize(network, columns, d);
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k] < 0) continue;
    const auto node = static_cast<Eigen::Index>(network.excitations[k].node);
    const double a = factor(values.excitation[k]);
    const double by = factor_derivative(values.excitation[k], direction.excitation[k]);
    if (network.excitations[k].kind == ExcitationKind::recorded_force) {
      recorded_load(network, node, first[k], d) += by;
      continue;
    }
    d.recorded_motion(node, first[k]) += by;
    add_support_forces(system, by, node, first[k], d.recorded_force);
    add_support_forces(d, a, node, first[k], d.recorded_force);
  }
  d.recorded_force += d.recorded_applied_force;
}

}  // namespace frahm::mechanics
