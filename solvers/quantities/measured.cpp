#include "solvers/quantities/measured.hpp"

namespace frahm::periodic {

void in_seconds(Eigen::Index masses, double step, Eigen::MatrixXd& gram) {
  gram.middleRows(masses, masses) /= step;
  gram.middleCols(masses, masses) /= step;
}

}  // namespace frahm::periodic
