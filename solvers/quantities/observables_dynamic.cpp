#include "solvers/quantities/observables.hpp"

template class frahm::periodic::TracedOrbit<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::Integrals<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::StepRows<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::EnergyScreen<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::OrbitMeasurement<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::Observables<Eigen::Dynamic, Eigen::Dynamic>;
