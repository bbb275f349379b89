#pragma once

#include <Eigen/Core>

namespace frahm::periodic {

// The directions in which no spring holds the masses (mechanics/free_directions.hpp), with time counted in
// steps: displacements R c and velocities R c' of coordinates c [sqrt(kg) m].
struct StepFree {
  Eigen::MatrixXd R;         // n x r, R^T M R = 1, M in kg [1/sqrt(kg)]; without columns where there is none
  Eigen::MatrixXd along;     // R^T M, r x n [sqrt(kg)]: c of a displacement
  Eigen::MatrixXd resisted;  // what takes up velocities along them, k x r (LinearSystem::resisted)
  // c' u(t) by the forcing alone, of zero mean, r x oscillators [sqrt(kg) m a step].
  Eigen::MatrixXd driven;
  // By bends of the displacement, b^T R of each, others 0; number x r.
  Eigen::MatrixXd bent;

  bool any() const { return R.cols() > 0; }
};

}  // namespace frahm::periodic
