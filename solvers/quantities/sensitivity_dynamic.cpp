#include "solvers/quantities/sensitivity_sizes.hpp"

template struct frahm::periodic::StepDerivative<Eigen::Dynamic, Eigen::Dynamic>;
template struct frahm::periodic::ModeDerivative<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::PassageSensitivity<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::OrbitSensitivity<Eigen::Dynamic, Eigen::Dynamic>;
