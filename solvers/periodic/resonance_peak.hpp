#pragma once

#include <functional>
#include <span>

namespace frahm::periodic {

// The highest peak of a response curve and its half-power points. Everything is NaN that the band does not
// hold.
struct ResonancePeak {
  double at, value;             // the resonance, and the response there
  double half_power_low = 0.0;  // the nearest places on either side where the response is value / sqrt(2)
  double half_power_high = 0.0;
};

// response(x): the amplitude at x, NaN where there is none.  grid: ascending or descending, at least three
// places; the peak is sought between neighbours of the highest, and a curve that is highest at an end of the
// grid has none. Solved, not sampled: where the curve is smooth the peak is a root of its slope, to about
// 1e-11 of the width between the half-power points.
ResonancePeak find_resonance_peak(const std::function<double(double)>& response,
                                  std::span<const double> grid);

}  // namespace frahm::periodic
