#include "solvers/tuning/exchange/band_scan.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/exchange/band_maxima.hpp"

namespace frahm::tuning {
namespace {

constexpr PlacesFineness kScan{.intervals = 48};

}  // namespace

double least_width_seen(const Band& band) {
  const double nearest = kScan.nearest * (band.to - band.from) / kScan.intervals;
  return std::max(nearest, kNarrowest * std::max(std::abs(band.from), std::abs(band.to)));
}

std::vector<std::vector<double>> places_of(const Task& task, const DesignSpace& space, const CurveKind& curve,
                                           std::span<const double> x, const PlacesFineness& fineness) {
  mechanics::NetworkValues values;
  std::vector<double> at(space.parameters() + 1);
  const auto values_at = [&](double band) -> const mechanics::NetworkValues& {
    for (std::size_t p = 0; p < space.parameters(); ++p) at[p] = space.interpolation(p, band, x).value;
    at.back() = band;
    task.network_at(curve.scenario, at, values, nullptr);
    return values;
  };
  std::vector<std::vector<double>> places;
  for (const Band& stretch : space.stretches(curve.band))
    places.push_back(resonance_places(task.network, values_at, stretch, space.knots(), fineness));
  return places;
}

BandScan::BandScan(const Task& task, const DesignSpace& space, const std::vector<CurveKind>& curves,
                   Effort& effort, const std::function<bool()>& stop_asked)
    : task_(task), space_(space), curves_(curves), stop_asked_(stop_asked) {
  for (const CurveKind& curve : curves_)
    responses_.push_back(std::make_unique<BandCurve>(task, space, curve, effort));
}

void BandScan::scan_curve(std::span<const double> x, std::size_t c, double floor, double accuracy,
                          Scan& scan) {
  BandCurve& curve = *responses_[c];
  Scan::Extreme motion;  // the highest that is not periodic
  const auto point_at = [&](double band) -> CurvePoint {
    if (stop_asked_()) return {band, kNone, kNone, kNone};
    const auto state = curve.solve(x, band, Derivatives::along_band);
    if (state == TunedResponse::State::solved && !curve.response().is_periodic() &&
        curve.value(BandCurve::larger) > motion.value)
      motion = {band, curve.value(BandCurve::larger), false};
    if (state == TunedResponse::State::solved) {
      constexpr std::size_t side = BandCurve::larger;
      return {band, curve.value(side), curve.slope_left(side), curve.slope_right(side)};
    }
    const bool unbounded = state == TunedResponse::State::unbounded;
    if (unbounded || !scan.unbounded) {
      (unbounded ? scan.unbounded : scan.failed) = true;
      scan.at = band;
      scan.reason = curve.reason();
    }
    return {band, unbounded ? kInfinity : kNone, kNone, kNone};
  };
  const bool may_jump = curve.response().may_jump();
  Scan::Extreme highest;
  for (const std::vector<double>& places : places_of(task_, space_, curves_[c], x, kScan)) {
    // Downwards first: the orbits found on the way are starts of the way up.
    for (auto place = places.rbegin(); may_jump && place != places.rend() && !stop_asked_(); ++place)
      curve.solve(x, *place, Derivatives::none);
    const BandMaxima found = find_band_maxima(point_at, places, floor, accuracy, may_jump);
    for (const CurvePoint& maximum : found.maxima) {
      const auto state = curve.solve(x, maximum.at, Derivatives::none);
      const std::size_t sides = state == TunedResponse::State::solved ? curve.sides() : 1;
      scan.maxima.push_back({c, maximum.at, maximum.value, sides, maximum.is_end});
    }
    for (const CurvePoint& sample : found.samples) {
      if (sample.value > highest.value) highest = {sample.at, sample.value};
    }
  }
  if (motion.value >= highest.value) highest = motion;
  scan.tightest.push_back(highest);
  if (curves_[c].of == CurveKind::Of::objective)
    scan.worst = std::max(scan.worst, highest.value);
  else
    scan.violation = std::max(scan.violation, highest.value - curves_[c].most());
}

Scan BandScan::of(std::span<const double> x, double floor, double accuracy) {
  Scan result;
  for (std::size_t c = 0; c < curves_.size(); ++c) scan_curve(x, c, floor, accuracy, result);
  return result;
}

}  // namespace frahm::tuning
