#pragma once

#include <span>
#include <vector>

#include "solvers/tuning/exchange/band_scan.hpp"
#include "solvers/tuning/exchange/goal.hpp"

namespace frahm::tuning {

// A place of the band at which a side of a curve is kept under its bound, or a local maximum that is followed
// as the design changes, between two places that it does not leave.
struct ActivePoint {
  std::size_t curve = 0;  // index among the problem's curves
  double at = 0.0;
  std::size_t side = BandCurve::larger;
  bool followed = false;
  double from = 0.0, to = 0.0;  // of a followed one
};

// Whether the design has to stay below a constant one everywhere.
bool has_dominated(const std::vector<CurveKind>& curves);

// The places of the band that the problem of a round is made of: a grid at first, then the true maxima of
// each design join, and what lies far below the bound goes.
class ActivePoints {
 public:
  // All must outlive the points. scan: of the first design; its maxima tell which curves have two sides.
  ActivePoints(const DesignSpace& space, const std::vector<CurveKind>& curves, const Goal& goal,
               const Scan& scan);

  const std::vector<ActivePoint>& all() const { return points_; }

  // The scan's maxima join. Of those that are followed, the ones before, which these are again, go. One that
  // is not takes the place of a point it differs from by next to nothing. follow: those that can be.
  void join(const Scan& scan, bool follow);

  // Drops points far below the bound, which only cost time; a scan finds those that rise again.
  // responses: of each point at the design found. worst: bound of the objective's.
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
