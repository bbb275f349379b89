#pragma once

#include <Eigen/Core>
#include <complex>

#include "solvers/mechanics/linear_system.hpp"

// Reference values for the harmonics of the reference order.
namespace frahm::periodic {

// Index of the reference order in LinearSystem::orders.
Eigen::Index reference_column(const mechanics::LinearSystem& system);

// |w^T q + p^T Y| of a coordinate, q = K^-1 (f - K_support Y): its displacement [m] under the reference
// order's amplitudes of force and motion, applied quasi-statically.
double static_displacement(const mechanics::LinearSystem& system, const mechanics::Incidence& at);

// Amplitude [m] at the reference order of the one support that moves at it; 0 where none or several do.
double support_amplitude(const mechanics::LinearSystem& system);

// Amplitude of the force on all supports together over that of the applied forces, at the reference order;
// NaN where no force is applied, and where the masses' motion does not tell what the supports take
// (SupportForce). X: components [m] of the masses' displacements at that order.
double force_transmissibility(const mechanics::LinearSystem& system, const Eigen::VectorXcd& X);

// Derivatives of the three above along `by`, the derivative of the system (mechanics/system_derivative.hpp),
// and X_by, that of X.
double static_displacement_derivative(const mechanics::LinearSystem& system,
                                      const mechanics::LinearSystem& by, const mechanics::Incidence& at);
double support_amplitude_derivative(const mechanics::LinearSystem& system, const mechanics::LinearSystem& by);
double force_transmissibility_derivative(const mechanics::LinearSystem& system,
                                         const mechanics::LinearSystem& by, const Eigen::VectorXcd& X,
                                         const Eigen::VectorXcd& X_by);

// The derivative of |z| where z changes by z_by; NaN at zero.
double modulus_derivative(std::complex<double> z, std::complex<double> z_by);

// a / b, NaN unless b > 0.
double ratio(double a, double b);

}  // namespace frahm::periodic
