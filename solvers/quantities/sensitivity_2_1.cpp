#include "solvers/quantities/sensitivity_sizes.hpp"

template struct frahm::periodic::StepDerivative<2, 1>;
template struct frahm::periodic::ModeDerivative<2, 1>;
template class frahm::periodic::PassageSensitivity<2, 1>;
template class frahm::periodic::OrbitSensitivity<2, 1>;
