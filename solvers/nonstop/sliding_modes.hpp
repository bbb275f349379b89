#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::periodic::nonstop {

// The modes of a system with all its contacts sliding, y' = A y + ..., y = (q [m], q' [m/s], s [N]) of D
// states: y = Re sum_s vector_s eta_s, eta_s = left_s y, where a conjugate pair counts once.
struct SlidingModes {
  Eigen::VectorXcd lambda;    // [1/s], size M
  std::vector<char> is_pair;  // of each mode
  Eigen::MatrixXcd vectors;   // D x M
  Eigen::MatrixXcd left;      // M x D; twice the left eigenvector of a pair
  Eigen::VectorXd norms;      // energy norm of each vector [sqrt(J)], size M
  // Real modal coordinates (Re eta, Im eta of a pair, eta of a real mode) to coordinates whose length is
  // sqrt(2) times the energy norm, and back; D x D.
  Eigen::MatrixXd to_energy, from_energy;
  // How many times rounding grows by way of the modes, at most: the ratio of the longest to the shortest
  // image of a unit of modal coordinates. 1 where modes are orthogonal in energy; infinite where there are
  // too few (critical damping).
  double condition = 0.0;

  Eigen::Index modes() const { return lambda.size(); }
};
SlidingModes sliding_modes(const mechanics::LinearSystem& system);

}  // namespace frahm::periodic::nonstop
