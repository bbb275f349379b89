#pragma once

#include "solvers/quantities/measured.hpp"

// The derivatives of the quantities (quantity_values.hpp) as functions of what was measured and its
// derivative.
namespace frahm::periodic::derivative_of {

using D = const MeasuredDerivative&;

Derivative amplitude(const Measured&, D, const Asked&);
Derivative peak(const Measured&, D, const Asked&);  // of any trace
Derivative peak_phase(const Measured&, D, const Asked&);
Derivative mean(const Measured&, D, const Asked&);
Derivative drift(const Measured&, D, const Asked&);
Derivative mean_velocity(const Measured&, D, const Asked&);
Derivative rms(const Measured&, D, const Asked&);
Derivative phase(const Measured&, D, const Asked&);  // of a mass or element
Derivative harmonic(const Measured&, D, const Asked&);
Derivative magnification(const Measured&, D, const Asked&);
Derivative transmissibility(const Measured&, D, const Asked&);
Derivative energy(const Measured&, D, const Asked&);
Derivative energy_share(const Measured&, D, const Asked&);
Derivative damping_energy(const Measured&, D, const Asked&);
Derivative damping_energy_share(const Measured&, D, const Asked&);
Derivative stuck_fraction(const Measured&, D, const Asked&);
Derivative energy_input(const Measured&, D, const Asked&);
Derivative force_transmissibility(const Measured&, D, const Asked&);
Derivative natural_frequency(const Measured&, D, const Asked&);
Derivative modal_damping(const Measured&, D, const Asked&);

// Fills in the derivative of Measured::loss.
void add_up_losses(const Measured& measured, MeasuredDerivative& by);

}  // namespace frahm::periodic::derivative_of
