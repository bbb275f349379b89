#pragma once

#include "solvers/flow/equations.hpp"

// What joints add to the displacement and velocity along an incidence, as rows on the state z = (q, v, s) and
// on the oscillators u; velocities a step.
namespace frahm::periodic {

// x = B q + X s + offset u
template <class Equations, class State, class Oscillators>
void add_joints(const Equations& eq, const Eigen::VectorXd& j, State& z, Oscillators& u) {
  const StepJoints& joints = eq.joints;
  z.head(eq.masses()) += joints.B.transpose() * j;
  z.tail(joints.X.cols()) += joints.X.transpose() * j;
  u += joints.offset.transpose() * j;
}

// x' = B v + X s' + offset' u  with  s' = k D^T v - rate s + drive u
template <class Equations, class State, class Oscillators>
void add_velocity_of_joints(const Equations& eq, const Eigen::VectorXd& j, State& z, Oscillators& u) {
  const Eigen::Index n = eq.masses();
  const Eigen::VectorXd s = eq.joints.X.transpose() * j;
  z.segment(n, n) += eq.joints.B.transpose() * j + eq.D * eq.internal_stiffness.cwiseProduct(s);
  z.tail(s.size()) -= eq.internal_rate.cwiseProduct(s);
  u += eq.joints.offset_velocity.transpose() * j + eq.internal_drive.transpose() * s;
}

// The displacement or velocity along an incidence, with its joints.
struct StateRow {
  Eigen::VectorXd z, u;
};
template <class Equations>
StateRow displacement_row(const Equations& eq, const mechanics::Incidence& at) {
  StateRow row{Eigen::VectorXd::Zero(eq.states()), eq.motion.transpose() * at.p};
  row.z.head(eq.masses()) = at.w;
  if (at.has_joint()) add_joints(eq, at.j, row.z, row.u);
  return row;
}
template <class Equations>
StateRow velocity_row(const Equations& eq, const mechanics::Incidence& at) {
  StateRow row{Eigen::VectorXd::Zero(eq.states()), eq.motion_velocity.transpose() * at.p};
  row.z.segment(eq.masses(), eq.masses()) = at.w;
  if (at.has_joint()) add_velocity_of_joints(eq, at.j, row.z, row.u);
  return row;
}

// The largest value of a row of velocities and internal forces at the energy norm 1:
//   sqrt(2 (w^T M^-1 w + w_s^T diag(k) w_s))
template <class Equations>
double largest_rate(const Equations& eq, const StateRow& row) {
  const Eigen::VectorXd w = row.z.segment(eq.masses(), eq.masses()), s = row.z.tail(eq.internal_forces());
  return std::sqrt(2.0 * (w.dot(eq.M_inverse * w) + s.cwiseAbs2().dot(eq.internal_stiffness)));
}

}  // namespace frahm::periodic
