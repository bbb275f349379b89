#pragma once

#include <functional>
#include <span>
#include <vector>

// The local maxima of a curve over a band, solved, not sampled.
namespace frahm::tuning {

struct CurvePoint {
  double at = 0.0;
  double value = 0.0;                          // NaN: no value there; infinite: without bound
  double slope_left = 0.0, slope_right = 0.0;  // exact; they differ at a kink known in advance
  bool is_end = false;                         // a maximum next to which the curve jumps down
};
using CurveAt = std::function<CurvePoint(double at)>;

// Intervals are halved down to this part of the larger end of the band.
inline constexpr double kNarrowest = 1e-9;

struct BandMaxima {
  std::vector<CurvePoint>
      maxima;  // ascending in `at`; the ends of the band are maxima where the curve falls inwards
  std::vector<CurvePoint> samples;  // all points at which the curve was evaluated, ascending
};

// seeds: ascending, at least one, the ends of the band first and last. They include every known kink and,
// around every resonance, points no further apart than its width: so the widths that the curve can have are
// known in advance.
//
// Between neighbours the cubic through values and slopes is tested at the middle: where it holds, the signs
// of the slopes show the curve's extremes; where it fails, both halves are tested in turn. A peak is missed
// only if a curve without it has the same value and slope at both ends and the middle. Intervals whose cubic
// cannot come near `floor` times the largest value are left out. accuracy: of the values, relative to the
// largest.
// may_jump: the curve is the worst of several orbits. Where one of them ends it falls by a jump, or goes on
// without a slope, and its last point is a maximum if the curve rises towards it. Two jumps between
// neighbouring points may hide.
BandMaxima find_band_maxima(const CurveAt& curve, std::span<const double> seeds, double floor,
                            double accuracy, bool may_jump = false);

}  // namespace frahm::tuning
