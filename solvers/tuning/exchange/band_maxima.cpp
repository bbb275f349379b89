#include "solvers/tuning/exchange/band_maxima.hpp"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>

namespace frahm::tuning {
namespace {

// Value and slope at the middle of the cubic through values and slopes at both ends.
struct Prediction {
  double value, slope;
};
Prediction middle_of_cubic(const CurvePoint& a, const CurvePoint& b) {
  const double h = b.at - a.at;
  return {0.5 * (a.value + b.value) + 0.125 * h * (a.slope_right - b.slope_left),
          1.5 * (b.value - a.value) / h - 0.25 * (a.slope_right + b.slope_left)};
}

bool is_finite(const CurvePoint& point) {
  return std::isfinite(point.value) && std::isfinite(point.slope_left) && std::isfinite(point.slope_right);
}

class Search {
 public:
  Search(const CurveAt& curve, double floor, double accuracy, bool may_jump)
      : curve_(curve), floor_(floor), accuracy_(accuracy), may_jump_(may_jump) {}

  BandMaxima over(std::span<const double> seeds) {
    std::vector<CurvePoint> points;
    for (const double seed : seeds) points.push_back(ask(seed));
    const double narrowest = kNarrowest * std::max(std::abs(seeds.front()), std::abs(seeds.back()));
    for (std::size_t i = 0; i + 1 < points.size(); ++i) search(points[i], points[i + 1], narrowest);
    consider_seeds(points);
    return finished();
  }

 private:
  CurvePoint ask(double at) {
    const CurvePoint point = curve_(at);
    found_.samples.push_back(point);
    if (std::isfinite(point.value)) largest_ = std::max(largest_, point.value);
    return point;
  }

  // A generous bound of a curve like the cubic between a and b.
  static double reach(const CurvePoint& a, const CurvePoint& b) {
    const double h = b.at - a.at;
    const double rise = std::max({a.slope_right * h, -b.slope_left * h, 0.0});
    return std::max(a.value, b.value) + rise + 0.5 * std::abs(b.value - a.value);
  }

  void search(const CurvePoint& a, const CurvePoint& b, double narrowest) {
    const double h = b.at - a.at;
    if (!is_finite(a) || !is_finite(b)) {
      // A point without a value between two that have one is left to the samples; its surroundings are
      // searched down to a thousandth of the seeds' spacing.
      const bool may_be_top = may_jump_ && rises_to_top(a, b);
      if (may_be_top && h <= narrowest) return add_end(is_finite(a) ? a : b);
      if ((h < 1e6 * narrowest && !may_be_top) || (!is_finite(a) && !is_finite(b))) return;
      const CurvePoint m = ask(0.5 * (a.at + b.at));
      search(a, m, narrowest);
      search(m, b, narrowest);
      return;
    }
    if (reach(a, b) < floor_ * largest_) return;
    if (h <= narrowest) {
      may_jump_ ? consider_jump(a, b) : consider_kink(a, b);
      return;
    }
    const CurvePoint m = ask(0.5 * (a.at + b.at));
    if (!is_finite(m)) {
      search(a, m, narrowest);
      search(m, b, narrowest);
      return;
    }
    const Prediction predicted = middle_of_cubic(a, b);
    const double error = std::abs(m.value - predicted.value) +
                         0.25 * h * std::abs(0.5 * (m.slope_left + m.slope_right) - predicted.slope);
    // Near the top the values matter to `accuracy`, elsewhere only whether there is a maximum.
    const bool near_top = reach(a, b) > 0.98 * largest_;
    if (error <= (near_top ? accuracy_ : 1e-2) * largest_) {
      climb(a, m);
      consider(m);
      climb(m, b);
    } else {
      search(a, m, narrowest);
      consider(m);
      search(m, b, narrowest);
    }
  }

  // The maximum between two points on a stretch where the slope changes its sign at most once.
  void climb(const CurvePoint& a, const CurvePoint& b) {
    if (!(a.slope_right > 0.0 && b.slope_left < 0.0)) return;
    CurvePoint last = a, highest = a.value > b.value ? a : b;
    const auto slope = [&](double at) {
      last = ask(at);
      if (last.value > highest.value) highest = last;
      const double mean = 0.5 * (last.slope_left + last.slope_right);
      return std::isnan(mean) ? 0.0 : mean;
    };
    constexpr std::uintmax_t kMostEvaluations = 60;
    std::uintmax_t evaluations = kMostEvaluations;
    const auto [left, right] =
        boost::math::tools::toms748_solve(slope, a.at, b.at, a.slope_right, b.slope_left,
                                          boost::math::tools::eps_tolerance<double>(46), evaluations);
    const CurvePoint top = ask(0.5 * (left + right));
    if (may_jump_ && highest.value > top.value * (1.0 + 1e-12)) {
      add_end(highest);  // the slopes changed their sign by a jump
      return;
    }
    found_.maxima.push_back(std::isfinite(top.value) ? top : last);
  }

  // A point that is a maximum by itself: a known kink, or a point exactly at the top.
  void consider(const CurvePoint& point) {
    if (point.slope_left >= 0.0 && point.slope_right <= 0.0) found_.maxima.push_back(point);
  }

  void consider_kink(const CurvePoint& a, const CurvePoint& b) {
    if (a.slope_right > 0.0 && b.slope_left < 0.0) found_.maxima.push_back(a.value > b.value ? a : b);
  }

  // Whether the curve rises from one of two points towards the other, which has no slope, and may there be
  // the highest of all.
  bool rises_to_top(const CurvePoint& a, const CurvePoint& b) const {
    const double rise = (b.at - a.at) * (is_finite(a) ? a.slope_right : -b.slope_left);
    return rise > 0.0 && (is_finite(a) ? a : b).value + rise > 0.98 * largest_;
  }

  // Where the curve jumps it ends on its higher side.
  void consider_jump(const CurvePoint& a, const CurvePoint& b) {
    if (a.value >= b.value && a.slope_right > 0.0) add_end(a);
    if (b.value > a.value && b.slope_left < 0.0) add_end(b);
  }

  void add_end(CurvePoint point) {
    point.is_end = true;
    found_.maxima.push_back(point);
  }

  void consider_seeds(const std::vector<CurvePoint>& points) {
    const CurvePoint &first = points.front(), &last = points.back();
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      if (is_finite(points[i])) consider(points[i]);
    }
    if (is_finite(first) && first.slope_right <= 0.0) found_.maxima.push_back(first);
    if (points.size() == 1) {
      if (first.slope_right > 0.0) found_.maxima.push_back(first);
    } else if (is_finite(last) && last.slope_left >= 0.0) {
      found_.maxima.push_back(last);
    }
  }

  BandMaxima finished() {
    const auto by_place = [](const CurvePoint& a, const CurvePoint& b) { return a.at < b.at; };
    const auto same_place = [](const CurvePoint& a, const CurvePoint& b) {
      return b.at - a.at <= 1e-12 * std::abs(b.at);
    };
    std::sort(found_.samples.begin(), found_.samples.end(), by_place);
    std::vector<CurvePoint>& maxima = found_.maxima;
    std::erase_if(maxima, [&](const CurvePoint& point) { return point.value < floor_ * largest_; });
    std::sort(maxima.begin(), maxima.end(), by_place);
    maxima.erase(std::unique(maxima.begin(), maxima.end(), same_place), maxima.end());
    return std::move(found_);
  }

  const CurveAt& curve_;
  double floor_, accuracy_;
  bool may_jump_;
  double largest_ = 0.0;
  BandMaxima found_;
};

}  // namespace

BandMaxima find_band_maxima(const CurveAt& curve, std::span<const double> seeds, double floor,
                            double accuracy, bool may_jump) {
  return Search(curve, floor, accuracy, may_jump).over(seeds);
}

}  // namespace frahm::tuning
