#pragma once

#include <functional>
#include <span>
#include <vector>

// The local maxima of a curve over a band, solved, not sampled.
namespace frahm::tuning {

struct CurvePoint {
  double at = 0.0;
  double value = 0.0;                          // NaN: it has none there; infinite: without bound
  double slope_left = 0.0, slope_right = 0.0;  // exact; they differ at a kink known in advance
};
using CurveAt = std::function<CurvePoint(double at)>;

struct BandMaxima {
  std::vector<CurvePoint>
      maxima;  // ascending in `at`; the ends of the band are maxima where the curve falls inwards
  std::vector<CurvePoint> samples;  // all points at which the curve was asked for, ascending
};

// seeds: ascending, at least one, the ends of the band first and last; among them every known kink, and
// around every resonance places no further apart than its width, so that the widths the curve can have are
// known in advance.
//
// Between neighbours the cubic through values and slopes is a prediction, tried at the middle: where it
// holds, the curve has the extremes that the slopes' signs say; where it fails, both halves are taken in
// turn. So a peak hides only where value and slope agree at both ends and the middle with a curve without it.
// Intervals whose cubic cannot come near `floor` times the largest value are left out. accuracy: of the
// values, relative to the largest.
BandMaxima find_band_maxima(const CurveAt& curve, std::span<const double> seeds, double floor,
                            double accuracy);

}  // namespace frahm::tuning
