#include "solvers/quantities/sensitivity_sizes.hpp"

template struct frahm::periodic::StepDerivative<1, 1>;
template struct frahm::periodic::ModeDerivative<1, 1>;
template class frahm::periodic::PassageSensitivity<1, 1>;
template class frahm::periodic::OrbitSensitivity<1, 1>;
