#include "solvers/quantities/observables.hpp"

template class frahm::periodic::TracedOrbit<2, 1>;
template class frahm::periodic::Integrals<2, 1>;
template class frahm::periodic::StepRows<2, 1>;
template class frahm::periodic::EnergyScreen<2, 1>;
template class frahm::periodic::OrbitMeasurement<2, 1>;
template class frahm::periodic::Observables<2, 1>;
