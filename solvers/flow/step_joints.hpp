#pragma once

#include <Eigen/Core>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::periodic {

// How the joints follow (mechanics/joints.hpp), with time counted in steps:
//   x = B q + X s + offset u(t),   s' = k (D^T v) - rate s + drive u(t).
struct StepJoints {
  Eigen::MatrixXd B, X;  // j x n, j x s
  // What loads of joints and supports do, j rows on the oscillators; and of drive, s rows, its rate.
  Eigen::MatrixXd offset, offset_velocity, offset_acceleration;
  Eigen::MatrixXd load;        // P(t) [N]
  Eigen::MatrixXd drive_rate;  // d(drive u)/dt [1/step]

  bool any() const { return B.rows() > 0; }
};

}  // namespace frahm::periodic
