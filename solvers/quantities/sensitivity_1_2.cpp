#include "solvers/quantities/sensitivity_sizes.hpp"

template struct frahm::periodic::StepDerivative<1, 2>;
template struct frahm::periodic::ModeDerivative<1, 2>;
template class frahm::periodic::PassageSensitivity<1, 2>;
template class frahm::periodic::OrbitSensitivity<1, 2>;
