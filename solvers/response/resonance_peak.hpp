#pragma once

#include <functional>
#include <span>

namespace frahm::periodic {

// The highest peak of a response curve and its half-power points. Everything is NaN that the band does not
// hold.
struct ResonancePeak {
  double at, value;       // the resonance, and the response there; infinite where nothing bounds it
  double half_power_low;  // the nearest places on either side where the response is value / sqrt(2)
  double half_power_high;
};

// response(x): the amplitude at x, x >= 0; infinite where none is large enough, NaN where there is none.
// grid: places in any order. Every local maximum of the grid's inner places is solved and the highest taken,
// so that a coarse grid does not choose between two modes. A curve that is highest at an end of the grid has
// no peak, one with places without a response about its peak no height.
//
// Solved, not sampled: where the curve is smooth the peak is a root of the slope of 1/response^2, to about
// 1e-11 of the width between the half-power points. Peaks narrower than kNarrowest of x cannot be told from
// unbounded ones, and are given as such.
ResonancePeak find_resonance_peak(const std::function<double(double)>& response,
                                  std::span<const double> grid);
inline constexpr double kNarrowest = 1e-11;

}  // namespace frahm::periodic
