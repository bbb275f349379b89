#pragma once

#include "solvers/flow/equations.hpp"
#include "solvers/quantities/measured.hpp"
#include "solvers/quantities/step_derivative.hpp"

namespace frahm::periodic {

// With y = (q, v, s, u) in seconds:  x = B q + X s + offset u,  x' = B v + X s' + offset' u,
// s' = k D^T v - rate s + drive u.
template <int N, int H>
JointRows joint_rows(const StepEquations<N, H>& eq) {
  const StepJoints& its = eq.joints;
  const Eigen::Index n = eq.masses(), s = eq.internal_forces(), first = 2 * n + s;
  JointRows rows;
  rows.displacement.setZero(its.B.rows(), first + eq.oscillators());
  rows.displacement.leftCols(n) = its.B;
  rows.displacement.middleCols(2 * n, s) = its.X;
  rows.displacement.rightCols(eq.oscillators()) = its.offset;
  rows.velocity.setZero(its.B.rows(), first + eq.oscillators());
  rows.velocity.middleCols(n, n) = its.B + its.X * eq.internal_stiffness.asDiagonal() * eq.D.transpose();
  rows.velocity.middleCols(2 * n, s) = -its.X * eq.internal_rate.asDiagonal() / eq.step;
  rows.velocity.rightCols(eq.oscillators()) = (its.offset_velocity + its.X * eq.internal_drive) / eq.step;
  return rows;
}

// Their derivatives. In seconds  d(r/h) = dr/h - (r/h) dh/h  of the rates r a step.
template <int N, int H>
JointRows joint_rows_derivative(const StepEquations<N, H>& eq, const StepDerivative<N, H>& by) {
  const StepJoints &its = eq.joints, &d = by.joints;
  const Eigen::Index n = eq.masses(), s = eq.internal_forces(), first = 2 * n + s;
  const double h = eq.step;
  JointRows rows;
  rows.displacement.setZero(its.B.rows(), first + eq.oscillators());
  rows.displacement.leftCols(n) = d.B;
  rows.displacement.middleCols(2 * n, s) = d.X;
  rows.displacement.rightCols(eq.oscillators()) = d.offset;
  rows.velocity.setZero(its.B.rows(), first + eq.oscillators());
  rows.velocity.middleCols(n, n) = d.B + d.X * eq.internal_stiffness.asDiagonal() * eq.D.transpose() +
                                   its.X * by.internal_by_state.middleCols(n, n);
  rows.velocity.middleCols(2 * n, s) =
      (its.X * by.internal_by_state.rightCols(s) - d.X * eq.internal_rate.asDiagonal()) / h;
  rows.velocity.rightCols(eq.oscillators()) =
      (d.offset_velocity + d.X * eq.internal_drive + its.X * by.internal_drive) / h;
  // Of rates alone: B v and X k D^T v are of velocities in seconds already.
  const Eigen::MatrixXd rates = by.log_step / h * its.X;
  rows.velocity.middleCols(2 * n, s) += rates * eq.internal_rate.asDiagonal();
  rows.velocity.rightCols(eq.oscillators()) -=
      rates * eq.internal_drive + by.log_step / h * its.offset_velocity;
  return rows;
}

}  // namespace frahm::periodic
