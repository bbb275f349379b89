#pragma once

#include <Eigen/Core>
#include <vector>

namespace frahm::periodic {

// What a sensor on a mass shows: its displacement (order 0 [m]), velocity (1 [m/s]) or acceleration (2).
struct Observed {
  Eigen::Index mass = 0;  // in Network::masses
  int order = 0;          // how often the displacement is differentiated by time
};

// What is observed of a motion at given times.
struct ObservedMotion {
  Eigen::MatrixXd values;           // times x observed [SI]
  std::vector<Eigen::MatrixXd> by;  // their derivatives along each direction, time held
};

}  // namespace frahm::periodic
