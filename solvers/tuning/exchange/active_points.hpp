#pragma once

#include <span>
#include <vector>

#include "solvers/tuning/exchange/band_scan.hpp"
#include "solvers/tuning/exchange/goal.hpp"

namespace frahm::tuning {

// A point of the band at which a side of a curve must stay under its bound, or a local maximum that is
// followed as the design changes, within an interval that it does not leave.
struct ActivePoint {
  std::size_t curve = 0;  // index among the problem's curves
  double at = 0.0;
  std::size_t side = BandCurve::larger;
  bool followed = false;
  double from = 0.0, to = 0.0;  // interval of a followed maximum
};

// Whether the design has to stay below a constant one everywhere.
bool has_dominated(const std::vector<CurveKind>& curves);

// The active points of a round's problem: a grid at first; then the true maxima of each design join, and
// points far below the bound are dropped.
class ActivePoints {
 public:
  // All must outlive the points. scan: of the first design; its maxima show which curves have two sides.
  ActivePoints(const DesignSpace& space, const std::vector<CurveKind>& curves, const Goal& goal,
               const Scan& scan);

  const std::vector<ActivePoint>& all() const { return points_; }

  // Replaces the followed maxima by those of the scan. A maximum that is not followed replaces a point almost
  // equal to it, or is added. follow: follows the maxima that can be followed.
  void join(const Scan& scan, bool follow);

  // Drops points far below the bound, which only cost time; a scan finds those that rise again.
  // responses: of each point at the design found. worst: bound of the objective's, of all for a violation.
  void drop_idle(std::span<const double> responses, double worst);

 private:
  bool is_bounded(std::size_t curve) const;
  void add_grid(std::size_t curve, const Scan& scan);
  bool can_follow(const Scan& scan, std::size_t maximum, ActivePoint& point) const;

  const std::vector<CurveKind>& curves_;
  const Goal& goal_;
  const std::vector<double> knots_;
  std::vector<ActivePoint> points_;
};

}  // namespace frahm::tuning
