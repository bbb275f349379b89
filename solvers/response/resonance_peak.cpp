#include "solvers/response/resonance_peak.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "solvers/algebra/no_value.hpp"

namespace frahm::periodic {
namespace {

using Function = std::function<double(double)>;
constexpr double kInfinite = kInfinity;
constexpr std::uintmax_t kMostEvaluations = 200;
constexpr std::size_t kMostMaxima = 16;  // solved: a curve of few modes has fewer

// The derivative by central differences of the eighth order (Fornberg, Math. Comp. 51 (1988) 699).
double slope(const Function& f, double x, double h) {
  constexpr std::array<double, 4> weight{4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
  double sum = 0.0;
  for (int k = 1; k <= 4; ++k) sum += weight[k - 1] * (f(x + k * h) - f(x - k * h));
  return sum / h;
}

template <class AnyFunction>
double root(const AnyFunction& f, double a, double b) {
  const double lo = std::min(a, b), hi = std::max(a, b);
  const double at_lo = f(lo), at_hi = f(hi);
  if (!(at_lo * at_hi <= 0.0)) return kNone;
  if (lo == hi) return lo;  // a narrow interval about x that rounding has closed
  std::uintmax_t evaluations = kMostEvaluations;
  const auto [left, right] = boost::math::tools::toms748_solve(
      f, lo, hi, at_lo, at_hi, boost::math::tools::eps_tolerance<double>(52), evaluations);
  return 0.5 * (left + right);
}

// Infinite where there is no response.
double inverse_square(double response) {
  return std::isnan(response) ? kInfinite : 1.0 / (response * response);
}

// A response curve at points x, ascending; its inverse square is smooth through the sharpest peak (for one
// mass it is a polynomial of x^2), zero where the response is infinite.
class Curve {
 public:
  Curve(const Function& response, std::span<const double> grid)
      : response_(response), places_(grid.begin(), grid.end()) {
    std::sort(places_.begin(), places_.end());
    for (const double place : places_) values_.push_back(inverse_square(response_(place)));
  }

  // The inner local maxima of the response, highest first.
  std::vector<std::size_t> maxima() const {
    std::vector<std::size_t> found;
    for (std::size_t i = 1; i + 1 < places_.size(); ++i) {
      if (values_[i] < values_[i - 1] && values_[i] <= values_[i + 1] && values_[i] < kInfinite)
        found.push_back(i);
    }
    std::sort(found.begin(), found.end(),
              [&](std::size_t a, std::size_t b) { return values_[a] < values_[b]; });
    if (found.size() > kMostMaxima) found.resize(kMostMaxima);
    return found;
  }

  // Whether an end of the grid is higher than `value` [1/response^2].
  bool ends_above(double value) const { return std::min(values_.front(), values_.back()) < value; }

  // The least inverse square next to point i, and its x; is_whole: there is a response all about it.
  struct Minimum {
    double at, value;
    bool is_whole;
  };
  Minimum least(std::size_t i) const {
    // 1. Between the neighbours, to about the root of rounding.
    const double left = places_[i - 1], right = places_[i + 1];
    bool has_gap = false;
    const auto f = [&](double x) {
      const double value = response_(x);
      has_gap = has_gap || (std::isnan(value) && left <= x && x <= right);
      return inverse_square(value);
    };
    std::uintmax_t evaluations = kMostEvaluations;
    auto [at, value] = boost::math::tools::brent_find_minima(f, left, right, 50, evaluations);
    if (values_[i] < value) std::tie(at, value) = std::pair(places_[i], values_[i]);
    // 2. The root of the slope close by, with differences over ever smaller parts of the interval, down to a
    // part of the peak's width.
    for (double h = (right - left) / 64.0;; h *= 0.25) {
      const auto [low, high] = half_power_points(at, value);
      const double width = std::fmin(high - at, at - low);
      // A peak without half-power points in the band is so flat that the first differences suffice.
      const bool last = !(width > 0.0) || h <= width / 64.0;
      if (width > 0.0) h = std::max(h, width / 64.0);
      const double solved = root([&](double x) { return slope(f, x, h); }, std::max(left, at - 8.0 * h),
                                 std::min(right, at + 8.0 * h));
      const double at_solved = std::isnan(solved) ? kInfinite : f(solved);
      if (at_solved <= value * (1.0 + 1e-9)) std::tie(at, value) = std::pair(solved, at_solved);
      if (last) break;
    }
    return {at, value, !has_gap};
  }

  // Where the response first falls to 1/sqrt(2) of that at the peak, on either side.
  std::pair<double, double> half_power_points(double peak, double inverse_square_there) const {
    const auto above = std::upper_bound(places_.begin(), places_.end(), peak);
    const auto first_above = static_cast<std::size_t>(above - places_.begin());
    std::vector<double> below(places_.begin(), std::lower_bound(places_.begin(), places_.end(), peak));
    std::reverse(below.begin(), below.end());
    const double level = std::sqrt(0.5 / inverse_square_there);
    return {crossing(below, peak, level), crossing(std::span(places_).subspan(first_above), peak, level)};
  }

 private:
  double crossing(std::span<const double> places, double from, double level) const {
    double inside = from;
    for (const double place : places) {
      const double value = response_(place);
      if (std::isnan(value)) return kNone;
      if (value < level) return root([&](double x) { return response_(x) - level; }, inside, place);
      inside = place;
    }
    return kNone;
  }

  const Function& response_;
  std::vector<double> places_, values_;  // values: inverse squares
};

}  // namespace

ResonancePeak find_resonance_peak(const Function& response, std::span<const double> grid) {
  const Curve curve(response, grid);
  ResonancePeak peak{kNone, kNone, kNone, kNone};
  double least = kInfinite;
  bool is_whole = true;
  for (const std::size_t i : curve.maxima()) {
    const auto minimum = curve.least(i);
    if (minimum.value >= least) continue;
    least = minimum.value;
    peak.at = minimum.at;
    is_whole = minimum.is_whole;
  }
  if (std::isnan(peak.at) || curve.ends_above(least)) return {kNone, kNone, kNone, kNone};
  if (!is_whole) return {peak.at, kNone, kNone, kNone};
  peak.value = 1.0 / std::sqrt(least);
  std::tie(peak.half_power_low, peak.half_power_high) = curve.half_power_points(peak.at, least);
  const bool unbounded = least == 0.0 || peak.half_power_high - peak.half_power_low < kNarrowest * peak.at;
  if (unbounded) return {peak.at, kInfinite, kNone, kNone};
  return peak;
}

}  // namespace frahm::periodic
