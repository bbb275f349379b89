#pragma once

#include <vector>

#include "solvers/identification/identification.hpp"
#include "solvers/identification/one_mass.hpp"
#include "solvers/identification/response_curve.hpp"

// Viscous damping and Coulomb friction to ground from the response at resonance, r = 1, to several amplitudes
// of the excitation, source [23]. With X the response, Y the support's amplitude (or P/k of a force),
// x_f = F/k and G, H Den Hartog's functions at r = 1:
//   Y = slope sqrt((X + G x_f)^2 + (H x_f)^2),    slope = 2 zeta / sqrt(1 + 4 zeta^2),   to a force 2 zeta,
// a hyperbola whose asymptote is, but for terms of zeta^2, the paper's line  Y = slope X + intercept:
//   slope = 2 zeta,  intercept = 2 zeta G x_f,  G = sinh(pi zeta) / (cosh(pi zeta) - 1).
// A support under the spring alone, with the damper on the ground, acts as the force k Y.
namespace frahm::identification {

// Pairs of amplitudes [m].
struct ResonancePairs {
  std::vector<double> response;    // X of the mass, > 0
  std::vector<double> excitation;  // Y of the support, or P/k, > 0
};

// Estimates: slope [1], intercept [m] of the line, damping_ratio_line, friction_displacement_line [m] by the
// paper's formulas; damping_ratio, friction_displacement [m] by least squares of the hyperbola; with mass
// and stiffness damping, damping_line [N s m-1], with the stiffness friction_force, friction_force_line [N].
// The residuals are those of the excitation, as in the paper: its error and slope times the response's.
// Scatter of the response makes the slope, and with it the damping, too small and the intervals too narrow: a
// note says so where it is large.
// failure: fewer than two pairs of different response, not positive, a line that does not rise, or so steeply
// that the damping ratio is not below 1.
Identification forced_resonance(const ResonancePairs& pairs, ResponseTo shaken_by, const OneMass& known = {});

// Lines that were fitted elsewhere.
struct ResonanceLines {
  std::vector<double> slope;      // [1], > 0; to a support < 1
  std::vector<double> intercept;  // [m]
};

// The same for the means of the lines; damping_ratio and friction_displacement take the line for the
// hyperbola's asymptote. Intervals come from the spread of the lines, NaN of one.
Identification forced_resonance(const ResonanceLines& lines, ResponseTo shaken_by, const OneMass& known = {});

}  // namespace frahm::identification
