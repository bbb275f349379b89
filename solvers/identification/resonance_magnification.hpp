#pragma once

#include <vector>

#include "solvers/identification/identification.hpp"
#include "solvers/identification/response_curve.hpp"

// The damping ratio from the height of a resonance peak over the static displacement.
namespace frahm::identification {

// zeta = X_st / (2 X_r), to first order, and exactly where X_r is the response at omega_n to a force.
double magnification_first_order(double static_displacement, double resonant);

// zeta of the viscous mass whose peak is X_r, exactly: X_r / X_st = 1 / (2 zeta sqrt(1 - zeta^2)) to a force;
// to a support X_st is its amplitude. 0 < X_st < X_r, otherwise NaN.
double magnification_exact(double static_displacement, double resonant, ResponseTo shaken_by);

struct MagnificationRows {
  std::vector<double> static_displacement, resonant;  // [m]
};

// Estimates: damping_ratio (exact), damping_ratio_first_order: means over the rows, with the interval of the
// mean (NaN of one row).  Rows: zeta, zeta_exact.  failure: no rows, values that are not 0 < static <
// resonant.
Identification resonance_magnification(const MagnificationRows& rows, ResponseTo shaken_by);

// The same from the peak of a curve, and peak_frequency [rad/s], peak_amplitude [m].
// The errors of all amplitudes of the curve are taken as equally large; if they are proportional to the
// amplitude, the interval is not that of 95 %.
// static_displacement [m]: P/k, or the amplitude of the support; taken as exact.
Identification resonance_magnification(const ResponseCurve& curve, double static_displacement,
                                       ResponseTo shaken_by);

}  // namespace frahm::identification
