#include "solvers/quantities/observables.hpp"

template class frahm::periodic::TracedOrbit<1, 1>;
template class frahm::periodic::Integrals<1, 1>;
template class frahm::periodic::StepRows<1, 1>;
template class frahm::periodic::EnergyScreen<1, 1>;
template class frahm::periodic::OrbitMeasurement<1, 1>;
template class frahm::periodic::Observables<1, 1>;
