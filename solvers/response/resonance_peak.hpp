#pragma once

#include <functional>
#include <span>

namespace frahm::periodic {

// The highest peak of a response curve and its half-power points. Values outside the band are NaN.
struct ResonancePeak {
  double at, value;       // the resonance, and the response there; infinite where nothing bounds it
  double half_power_low;  // the nearest x on either side where the response is value / sqrt(2)
  double half_power_high;
};

// response(x): the amplitude at x, x >= 0; infinite where no amplitude is large enough, NaN where there is no
// response. grid: values of x in any order. Every local maximum at an inner grid point is solved and the
// highest taken, so that a coarse grid does not choose between two modes. A curve that is highest at an end
// of the grid has no peak; a peak with points without a response about it has no height.
//
// Solved, not sampled: where the curve is smooth the peak is a root of the slope of 1/response^2, to about
// 1e-11 of the width between the half-power points. Peaks narrower than kNarrowest of x cannot be
// distinguished from unbounded ones, and are returned as such.
ResonancePeak find_resonance_peak(const std::function<double(double)>& response,
                                  std::span<const double> grid);
inline constexpr double kNarrowest = 1e-11;

}  // namespace frahm::periodic
