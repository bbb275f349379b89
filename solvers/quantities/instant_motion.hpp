#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/quantities/trace.hpp"

// The derivative of a trace at one instant of a motion.
namespace frahm::periodic {

// Displacements, velocities, accelerations [SI] of the masses, of the prescribed nodes, and of the joints.
struct Kinematics {
  Eigen::VectorXd q, v, a;
  Eigen::VectorXd x, x_velocity, x_acceleration;
  Eigen::VectorXd y, y_velocity, y_acceleration;
};

struct ContactForce {
  bool sticks = false;
  double direction = 1.0;              // of a sliding contact
  double force = 0.0, force_by = 0.0;  // lambda [N] of one that sticks, and its derivative
};

// A motion at one instant, seen from inside a mode, and its derivative along a direction, time held.
struct InstantMotion {
  Kinematics at, by;
  Eigen::VectorXd internal_by;  // of the internal forces [N]
  // Where forces are traced: those of the contacts, and the derivative of each bend's [N], 0 before its
  // place.
  std::vector<ContactForce> contacts;
  std::vector<double> bends_by;
};

// Along an incidence: the derivative of its velocity [m/s], and its acceleration [m/s^2].
double velocity_derivative(const mechanics::Incidence& at, const InstantMotion& motion);
double acceleration_of(const mechanics::Incidence& at, const InstantMotion& motion);

// system_by: the derivative of `system`.
double trace_derivative(const Trace& trace, const InstantMotion& motion, const mechanics::Assembly& assembly,
                        const mechanics::LinearSystem& system, const mechanics::LinearSystem& system_by);

}  // namespace frahm::periodic
