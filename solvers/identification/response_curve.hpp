#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "solvers/identification/identification.hpp"

// The measured amplitude of one mass on a spring over the frequency, and its peak.
namespace frahm::identification {

// What shakes the mass: a force of constant amplitude on it, or a support of constant amplitude under spring
// and damper. The amplitude measured is that of the mass's own displacement.
enum class ResponseTo { force, support };

struct ResponseCurve {
  std::vector<double> omega;      // [rad/s], > 0, increasing
  std::vector<double> amplitude;  // > 0, of one unit; one for each frequency
};

// The peak, and the frequencies on either side where the amplitude is 1/sqrt(2) of it. 1/X^2 is a parabola of
// omega^2 for a viscous mass under a force, and smooth for any other mass: it is fitted by a polynomial of
// omega^2 by least squares of X over the points about the peak with X > kPeakPart X_max and the next on
// either side, of the degree that Akaike's corrected criterion prefers.
struct CurvePeak {
  std::string failure;              // why there is none, a sentence; empty: there is one
  double omega = 0.0;               // [rad/s]
  double amplitude = 0.0;           // of the unit of the curve
  double lower = 0.0, upper = 0.0;  // half-power points [rad/s]
  // Covariance of omega, amplitude, lower, upper, in this order; NaN: no more points than coefficients.
  Eigen::Matrix4d covariance;
  double degrees_of_freedom = 0.0;
  std::vector<double> at, measured, fitted;  // the fitted points: omega, amplitude, and the fit
};
inline constexpr double kPeakPart = 0.5;  // so that the half-power points, at 0.71, lie well inside
CurvePeak curve_peak(const ResponseCurve& curve, ResponseTo shaken_by);

// The fitted points, for a residual plot.
FittedRecord fitted_record(const CurvePeak& peak);

}  // namespace frahm::identification
