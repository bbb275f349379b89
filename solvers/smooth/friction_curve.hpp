#pragma once

#include <vector>

#include "solvers/mechanics/network.hpp"

namespace frahm::smooth {

struct ForceAndSlope {
  double force = 0.0, slope = 0.0;  // [N], [N s/m] or [N/m]
};

// Friction over the velocity through given points, odd: N(-v) = -N(v). Between two points it is the cubic of
// Fritsch and Carlson, which rises where they rise, falls where they fall and joins the next one with one
// slope; beyond the last point the force stays as it is there.
// Source: F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300.
class FrictionCurve {
 public:
  // points: two at least, from (0, 0), of rising speed.
  explicit FrictionCurve(std::vector<mechanics::CurvePoint> points);

  ForceAndSlope at(double v) const;
  double last_speed() const { return points_.back().speed; }  // [m/s]

 private:
  std::vector<mechanics::CurvePoint> points_;
  std::vector<double> slopes_;  // at each point [N s/m]
};

}  // namespace frahm::smooth
