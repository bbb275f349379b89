#include "solvers/smooth/friction_curve.hpp"

#include <algorithm>
#include <cmath>

namespace frahm::smooth {

// Inside  d_i = (h_(i-1) + h_i) 3 / (w_1/s_(i-1) + w_2/s_i),  w_1 = 2 h_i + h_(i-1),  w_2 = h_i + 2 h_(i-1),
// of the slopes s of the chords, and 0 where they differ in sign; so at the origin, where the curve is odd,
// d_0 = s_0. At the last point 0.
FrictionCurve::FrictionCurve(std::vector<mechanics::CurvePoint> points)
    : points_(std::move(points)), slopes_(points_.size(), 0.0) {
  const auto width = [&](std::size_t i) { return points_[i + 1].speed - points_[i].speed; };
  const auto chord = [&](std::size_t i) { return (points_[i + 1].force - points_[i].force) / width(i); };
  slopes_.front() = chord(0);
  for (std::size_t i = 1; i + 1 < points_.size(); ++i) {
    const double before = chord(i - 1), after = chord(i), h = width(i - 1), next = width(i);
    if (before * after <= 0.0) continue;
    slopes_[i] = 3.0 * (h + next) / ((2.0 * next + h) / before + (next + 2.0 * h) / after);
  }
}

// Hermite's cubic: N_0 + x (d_0 + x (c + x b)) with x = v - v_0 and the chord's slope s,
//   c = (3 s - 2 d_0 - d_1)/h,  b = (d_0 - 2 s + d_1)/h^2
ForceAndSlope FrictionCurve::at(double v) const {
  const double speed = std::abs(v), side = v < 0.0 ? -1.0 : 1.0;
  if (speed >= last_speed()) return {side * points_.back().force, 0.0};
  const auto next = std::ranges::upper_bound(points_, speed, {}, &mechanics::CurvePoint::speed);
  const auto i = static_cast<std::size_t>(next - points_.begin()) - 1;
  const double h = points_[i + 1].speed - points_[i].speed, x = speed - points_[i].speed;
  const double s = (points_[i + 1].force - points_[i].force) / h, d0 = slopes_[i], d1 = slopes_[i + 1];
  const double c = (3.0 * s - 2.0 * d0 - d1) / h, b = (d0 - 2.0 * s + d1) / (h * h);
  return {side * (points_[i].force + x * (d0 + x * (c + x * b))), d0 + x * (2.0 * c + x * 3.0 * b)};
}

}  // namespace frahm::smooth
