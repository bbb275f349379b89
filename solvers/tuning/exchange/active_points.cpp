#include "solvers/tuning/exchange/active_points.hpp"

#include <algorithm>
#include <cmath>

namespace frahm::tuning {
namespace {

constexpr int kFirstIntervals = 32;               // of the first active frequencies
constexpr double kSamePlace = 1e-7;               // frequencies closer than this, relative, are one
constexpr double kWithinPiece = 1.0 - 1e-6;       // of the way to a knot, on which the next piece begins
constexpr double kAcrossLeap = 1.5 * kLeapWidth;  // knots closer than this, relative, are sides of a leap
constexpr double kIdle = 0.8;                     // of the bound

// Both sides of a peak without symmetry; otherwise the larger one, which stands for both.
std::vector<std::size_t> sides_of(std::size_t sides) {
  if (sides == 2) return {0, 1};
  return {BandCurve::larger};
}

// An even grid, or the knots and the middles between them; ascending.
std::vector<double> grid(const Band& band, const std::vector<double>& knots) {
  std::vector<double> places = knots;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double width = knots[i + 1] - knots[i];
    if (width > kAcrossLeap * std::abs(band.to)) places.push_back(knots[i] + 0.5 * width);
  }
  if (knots.empty()) {
    for (int i = 0; i <= kFirstIntervals; ++i)
      places.push_back(band.from + (band.to - band.from) * i / kFirstIntervals);
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace

bool has_dominated(const std::vector<CurveKind>& curves) {
  return std::any_of(curves.begin(), curves.end(),
                     [](const CurveKind& curve) { return curve.of == CurveKind::Of::dominated; });
}

ActivePoints::ActivePoints(const DesignSpace& space, const std::vector<CurveKind>& curves, const Goal& goal,
                           const Scan& scan)
    : curves_(curves), goal_(goal), knots_(space.knots()) {
  const bool dominates = has_dominated(curves);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    // A curve that stays below the constant design everywhere needs no grid of its own.
    const bool is_covered = dominates && curves[c].of == CurveKind::Of::objective;
    if (is_bounded(c) && !is_covered) add_grid(c, scan);
  }
}

// Whether the goal bounds a curve; otherwise it only integrates the curve.
bool ActivePoints::is_bounded(std::size_t curve) const {
  return curves_[curve].of != CurveKind::Of::objective || goal_.of == Goal::Of::worst ||
         goal_.of == Goal::Of::mean_response;
}

void ActivePoints::add_grid(std::size_t curve, const Scan& scan) {
  const Band band = curves_[curve].band;
  std::size_t sides = 1;
  for (const Scan::Maximum& maximum : scan.maxima) {
    if (maximum.curve == curve) sides = std::max(sides, maximum.sides);
  }
  for (const double place : grid(band, knots_)) {
    if (place < band.from || place > band.to) continue;
    for (const std::size_t side : sides_of(sides))
      points_.push_back({.curve = curve, .at = place, .side = side});
  }
}

void ActivePoints::join(const Scan& scan, bool follow) {
  std::erase_if(points_, [](const ActivePoint& point) { return point.followed; });
  for (std::size_t i = 0; i < scan.maxima.size(); ++i) {
    const Scan::Maximum& maximum = scan.maxima[i];
    if (!is_bounded(maximum.curve)) continue;
    for (const std::size_t side : sides_of(maximum.sides)) {
      ActivePoint point{.curve = maximum.curve, .at = maximum.at, .side = side};
      point.followed = follow && can_follow(scan, i, point);
      const auto near = std::find_if(points_.begin(), points_.end(), [&](const ActivePoint& other) {
        return !point.followed && other.curve == point.curve && other.side == side &&
               std::abs(other.at - point.at) <= kSamePlace * std::abs(point.at);
      });
      if (near == points_.end())
        points_.push_back(point);
      else
        *near = point;
    }
  }
}

// A maximum inside the band and inside a piece of every schedule can be followed half the way to the next
// maximum or knot on either side.
bool ActivePoints::can_follow(const Scan& scan, std::size_t i, ActivePoint& point) const {
  const Band band = curves_[point.curve].band;
  point.from = band.from;
  point.to = band.to;
  const auto keep_off = [&](double place, double share) {
    if (place < point.at) point.from = std::max(point.from, point.at - share * (point.at - place));
    if (place > point.at) point.to = std::min(point.to, point.at + share * (place - point.at));
  };
  for (std::size_t k = 0; k < scan.maxima.size(); ++k) {
    if (k != i && scan.maxima[k].curve == point.curve) keep_off(scan.maxima[k].at, 0.5);
  }
  for (const double knot : knots_) {
    keep_off(knot, kWithinPiece);
    if (std::abs(knot - point.at) <= kSamePlace * std::abs(knot)) return false;
  }
  return point.at - point.from > kSamePlace * point.at && point.to - point.at > kSamePlace * point.at;
}

void ActivePoints::drop_idle(std::span<const double> responses, double worst) {
  std::size_t place = 0;
  std::erase_if(points_, [&](const ActivePoint& point) {
    const bool below_worst =
        curves_[point.curve].of == CurveKind::Of::objective || goal_.of == Goal::Of::violation;
    const double bound = below_worst ? worst : 1.0;
    return responses[place++] < kIdle * bound;
  });
}

}  // namespace frahm::tuning
