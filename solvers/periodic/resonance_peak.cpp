#include "solvers/periodic/resonance_peak.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

namespace frahm::periodic {
namespace {

using Response = std::function<double(double)>;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::uintmax_t kMostEvaluations = 200;

// The derivative by central differences of the eighth order (Fornberg, Math. Comp. 51 (1988) 699).
double slope(const Response& response, double x, double h) {
  constexpr std::array<double, 4> weight{4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0};
  double sum = 0.0;
  for (int k = 1; k <= 4; ++k) sum += weight[k - 1] * (response(x + k * h) - response(x - k * h));
  return sum / h;
}

template <class Function>
double root(const Function& f, double a, double b) {
  const double lo = std::min(a, b), hi = std::max(a, b);
  const double at_lo = f(lo), at_hi = f(hi);
  if (!(at_lo * at_hi <= 0.0)) return kNone;
  std::uintmax_t evaluations = kMostEvaluations;
  const auto [left, right] = boost::math::tools::toms748_solve(
      f, lo, hi, at_lo, at_hi, boost::math::tools::eps_tolerance<double>(52), evaluations);
  return 0.5 * (left + right);
}

// From the peak towards one end of the grid: where the response first falls to `level`.
double crossing(const Response& response, std::span<const double> places, double from, double level) {
  double inside = from;
  for (const double place : places) {
    const double value = response(place);
    if (std::isnan(value)) return kNone;
    if (value < level) return root([&](double x) { return response(x) - level; }, inside, place);
    inside = place;
  }
  return kNone;
}

void find_half_power_points(const Response& response, std::span<const double> grid, std::size_t highest,
                            ResonancePeak& peak) {
  const double level = peak.value / std::numbers::sqrt2;
  std::vector<double> below(grid.begin(), grid.begin() + static_cast<std::ptrdiff_t>(highest));
  std::reverse(below.begin(), below.end());
  peak.half_power_low = crossing(response, below, peak.at, level);
  peak.half_power_high = crossing(response, grid.subspan(highest + 1), peak.at, level);
}

}  // namespace

ResonancePeak find_resonance_peak(const Response& response, std::span<const double> grid) {
  std::vector<double> places(grid.begin(), grid.end());
  std::sort(places.begin(), places.end());
  std::vector<double> values;
  for (const double place : places) {
    const double value = response(place);
    values.push_back(std::isnan(value) ? -std::numeric_limits<double>::infinity() : value);
  }
  const auto highest =
      static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
  ResonancePeak peak{kNone, kNone, kNone, kNone};
  if (highest == 0 || highest + 1 >= places.size()) return peak;

  // 1. Between the neighbours, to about the root of rounding.
  const double left = places[highest - 1], right = places[highest + 1];
  const auto negative = [&](double x) {
    const double value = response(x);
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : -value;
  };
  std::uintmax_t evaluations = kMostEvaluations;
  const auto [at, value] = boost::math::tools::brent_find_minima(negative, left, right, 26, evaluations);
  peak.at = at;
  peak.value = -value;
  find_half_power_points(response, places, highest, peak);

  // 2. The root of the slope close by, with differences over a small part of the peak's width.
  double width = std::min(peak.half_power_high - peak.at, peak.at - peak.half_power_low);
  if (std::isnan(width)) width = 0.5 * (right - left);
  const double h = width / 64.0;
  const double solved =
      root([&](double x) { return slope(response, x, h); }, peak.at - 0.5 * h, peak.at + 0.5 * h);
  if (!std::isnan(solved)) {
    peak.at = solved;
    peak.value = response(solved);
    find_half_power_points(response, places, highest, peak);
  }
  return peak;
}

}  // namespace frahm::periodic
