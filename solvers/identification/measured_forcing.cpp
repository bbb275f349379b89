#include "solvers/identification/measured_forcing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::identification {
namespace {

using mechanics::ExcitationKind;
using mechanics::ExcitationValue;
using mechanics::NetworkValues;

constexpr double kQuarter = 0.5 * std::numbers::pi;

// Slope at t[0] of the parabola through three points.
double end_slope(const double* t, const double* y, int towards) {
  const double h1 = t[towards] - t[0], h2 = t[2 * towards] - t[0];
  return ((y[towards] - y[0]) * h2 * h2 - (y[2 * towards] - y[0]) * h1 * h1) / (h1 * h2 * (h2 - h1));
}

// Slopes of the cubic spline: continuous second derivatives,
//   s_{i-1}/h_{i-1} + 2 s_i (1/h_{i-1} + 1/h_i) + s_{i+1}/h_i = 3 (dy_{i-1}/h_{i-1}^2 + dy_i/h_i^2)
// (de Boor, A Practical Guide to Splines, 1978, ch. IV), by Gauss elimination.
std::vector<double> spline_slopes(const std::vector<double>& t, const std::vector<double>& y) {
  const std::size_t n = y.size();
  std::vector<double> slope(n), above(n, 0.0);
  slope[0] = end_slope(&t[0], &y[0], 1);
  slope[n - 1] = end_slope(&t[n - 1], &y[n - 1], -1);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = 1.0 / (t[i] - t[i - 1]), after = 1.0 / (t[i + 1] - t[i]);
    const double right = 3.0 * ((y[i] - y[i - 1]) * before * before + (y[i + 1] - y[i]) * after * after);
    const double pivot = 2.0 * (before + after) - before * above[i - 1];
    above[i] = after / pivot;
    slope[i] = (right - before * slope[i - 1]) / pivot;
  }
  for (std::size_t i = n - 2; i > 0; --i) slope[i] -= above[i] * slope[i + 1];
  return slope;
}

}  // namespace

MeasuredForcing::MeasuredForcing(const mechanics::Network& network, const TimeRecord& record)
    : network_(network), time_(record.time) {
  network_.excitations.clear();
  network_.reference_order = 1;
  for (const MeasuredExcitation& measured : record.excitation) {
    columns_.push_back({measured.kind, measured.values, {}});
    const std::vector<int> orders =
        measured.kind == ExcitationKind::force ? std::vector<int>{0, 1} : std::vector<int>{0, 1, 2};
    for (const int order : orders) network_.excitations.push_back({measured.kind, measured.node, order});
    if (measured.kind == ExcitationKind::force) continue;
    if (time_.size() < 3)
      throw mechanics::MechanicsError("record '" + record.name + "': a measured displacement needs 3 values");
    columns_.back().slopes = spline_slopes(time_, measured.values);
  }
  double longest = 0.0;
  for (std::size_t i = 0; i + 1 < time_.size(); ++i) longest = std::max(longest, time_[i + 1] - time_[i]);
  omega_ = kTurned / longest;
}

NetworkValues MeasuredForcing::values_of(const NetworkValues& model) const {
  NetworkValues values = model;
  values.omega = omega_;
  values.excitation.assign(network_.excitations.size(), {});
  return values;
}

NetworkValues MeasuredForcing::direction_of(const NetworkValues& by) const {
  NetworkValues direction = values_of(by);
  direction.omega = 0.0;
  return direction;
}

// With H half an interval in psi, y and its slopes d by psi at both ends, of their sums and differences:
//   a = -(d1 - d0) / (2 sin H),             c = (y0 + y1)/2 - a cos H
//   e = (y1 - y0)/2, d = (d0 + d1)/2:       p sin H + b sin 2H = e,  p cos H + 2 b cos 2H = d
void MeasuredForcing::set_interval(std::size_t i, NetworkValues& values) const {
  const double H = 0.5 * omega_ * (time_[i + 1] - time_[i]), sin = std::sin(H), cos = std::cos(H);
  std::size_t place = 0;
  for (const Column& column : columns_) {
    const double mean = 0.5 * (column.values[i] + column.values[i + 1]);
    const double e = 0.5 * (column.values[i + 1] - column.values[i]);
    if (column.kind == ExcitationKind::force) {
      values.excitation[place++] = {mean, 0.0};
      values.excitation[place++] = {e / sin, -H - kQuarter};
      continue;
    }
    const double d0 = column.slopes[i] / omega_, d1 = column.slopes[i + 1] / omega_, d = 0.5 * (d0 + d1);
    const double a = -0.5 * (d1 - d0) / sin, determinant = -2.0 * sin * sin * sin;
    const double p = 2.0 * (e * std::cos(2.0 * H) - d * sin * cos) / determinant;
    const double b = (d * sin - e * cos) / determinant;
    values.excitation[place++] = {mean - a * cos, 0.0};
    values.excitation[place++] = {std::hypot(a, p), -H - std::atan2(p, a)};
    values.excitation[place++] = {b, -2.0 * H - kQuarter};
  }
}

}  // namespace frahm::identification
