#pragma once

#include "solvers/flow/linear_form.hpp"
#include "solvers/quantities/orbit_sensitivity.hpp"

// The sensitivities of each size are compiled once, in a file of their own (sensitivity_1_1.cpp ...).
namespace frahm::periodic {

extern template struct StepDerivative<1, 1>;
extern template struct StepDerivative<2, 1>;
extern template struct StepDerivative<Eigen::Dynamic, Eigen::Dynamic>;
extern template struct ModeDerivative<1, 1>;
extern template struct ModeDerivative<2, 1>;
extern template struct ModeDerivative<Eigen::Dynamic, Eigen::Dynamic>;
extern template class PassageSensitivity<1, 1>;
extern template class PassageSensitivity<2, 1>;
extern template class PassageSensitivity<Eigen::Dynamic, Eigen::Dynamic>;
extern template class OrbitSensitivity<1, 1>;
extern template class OrbitSensitivity<2, 1>;
extern template class OrbitSensitivity<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
