#pragma once

#include <vector>

#include "solvers/identification/identification.hpp"
#include "solvers/identification/response_curve.hpp"

// The equivalent viscous damping ratio from the width of a resonance peak, where the amplitude has fallen to
// 1/sqrt(2): half the power. For any damper, particle dampers included.
namespace frahm::identification {

// zeta = (f2 - f1) / (2 f_n), to first order in zeta. Frequencies > 0 of one unit.
double half_power_first_order(double peak, double lower, double upper);

// zeta of the viscous mass whose half-power points are f1 < f2, exactly. 0 < f1 < f2 of one unit, otherwise
// NaN. Force:    zeta = sin(atan((f2^2 - f1^2) / (f2^2 + f1^2)) / 2), up to sin(pi/8). Support:  solved, up
// to 0.5412; with more damping the peak is less than sqrt(2) high.
double half_power_exact(double lower, double upper, ResponseTo shaken_by);

// Rows of a table, frequencies of one unit.
struct HalfPowerRows {
  std::vector<double> peak, lower, upper;
};

// Rows: zeta (first order), zeta_exact, and increase = zeta / zeta of the first row - 1.  No estimates.
// failure: no rows, lengths that differ, frequencies that are not 0 < lower < peak < upper.
Identification half_power(const HalfPowerRows& rows, ResponseTo shaken_by);

// Estimates: damping_ratio (exact), damping_ratio_first_order, peak_frequency, natural_frequency (of the
// undamped mass: the peak of a force's response lies at omega_n sqrt(1 - 2 zeta^2)), lower_frequency,
// upper_frequency [rad/s].  failure: no peak inside the curve, or half-power points beyond its ends.
// The errors of all amplitudes of the curve are taken as equally large; if they are proportional to the
// amplitude, the intervals are not those of 95 %.
Identification half_power(const ResponseCurve& curve, ResponseTo shaken_by);

}  // namespace frahm::identification
