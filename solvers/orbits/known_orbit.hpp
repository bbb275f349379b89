#pragma once

#include <Eigen/Core>

namespace frahm::periodic {

// A stable orbit of one point, as a start of the search at a point near it.
struct KnownOrbit {
  Eigen::VectorXd state;  // at phase 0: positions [m], velocities [m/s], internal forces [N]
  int multiple = 1;       // of the forcing's period, that it takes
};

}  // namespace frahm::periodic
