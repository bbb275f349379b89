#include "solvers/identification/measured_forcing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::identification {
namespace {

using mechanics::ExcitationKind;
using mechanics::ExcitationValue;
using mechanics::NetworkValues;

// Slope at t[0] of the parabola through three points.
double end_slope(const double* t, const double* y, int towards) {
  const double h1 = t[towards] - t[0], h2 = t[2 * towards] - t[0];
  return ((y[towards] - y[0]) * h2 * h2 - (y[2 * towards] - y[0]) * h1 * h1) / (h1 * h2 * (h2 - h1));
}

// Slopes of the cubic spline: continuous second derivatives,
//   s_{i-1}/h_{i-1} + 2 s_i (1/h_{i-1} + 1/h_i) + s_{i+1}/h_i = 3 (dy_{i-1}/h_{i-1}^2 + dy_i/h_i^2)
// (source [27], ch. IV), by Gauss elimination.
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

// Orders of which none is twice another: those with an even power of two, 1, 3, 4, 5, 7, 9, 11, 12 ...
int next_order(int order) {
  for (++order;; ++order) {
    int twos = 0;
    for (int rest = order; rest % 2 == 0; rest /= 2) ++twos;
    if (twos % 2 == 0) return order;
  }
}

// Coefficients of cos psi, cos 2 psi, sin psi, sin 2 psi.
struct Wave {
  double a = 0.0, c = 0.0, p = 0.0, b = 0.0;
};

// From y and its slopes d by psi at both ends, psi = -H and H, by their sums and differences:
//   a cos H + c cos 2H = (y0 + y1)/2 = mean,   a sin H + 2 c sin 2H = (d0 - d1)/2 = bend,
//   p sin H + b sin 2H = (y1 - y0)/2 = e,      p cos H + 2 b cos 2H = (d0 + d1)/2 = d
Wave spline_wave(double y0, double y1, double d0, double d1, double H) {
  const double sin = std::sin(H), cos = std::cos(H), sin2 = std::sin(2.0 * H), cos2 = std::cos(2.0 * H);
  const double mean = 0.5 * (y0 + y1), bend = 0.5 * (d0 - d1), e = 0.5 * (y1 - y0), d = 0.5 * (d0 + d1);
  const double even = sin * (2.0 * cos * cos + 1.0);  // 2 cos H sin 2H - sin H cos 2H
  const double odd = -2.0 * sin * sin * sin;          // 2 sin H cos 2H - cos H sin 2H
  return {.a = (2.0 * sin2 * mean - cos2 * bend) / even,
          .c = (cos * bend - sin * mean) / even,
          .p = (2.0 * cos2 * e - sin2 * d) / odd,
          .b = (sin * d - cos * e) / odd};
}

// Linear, as far as the even part is constant and the odd part sin psi.
Wave linear_wave(double y0, double y1, double H) {
  const double cos = std::cos(H), mean = 0.5 * (y0 + y1), even = 2.0 * cos * cos + 1.0;
  return {.a = 4.0 * cos * mean / even, .c = -mean / even, .p = 0.5 * (y1 - y0) / std::sin(H), .b = 0.0};
}

std::size_t place_of(int order, const std::vector<int>& orders) {
  return static_cast<std::size_t>(std::lower_bound(orders.begin(), orders.end(), order) - orders.begin());
}

}  // namespace

MeasuredForcing::MeasuredForcing(const mechanics::Network& network, const TimeRecord& record)
    : network_(network), time_(record.time) {
  network_.excitations.clear();
  network_.reference_order = 1;
  int order = 0;
  for (const MeasuredExcitation& measured : record.excitation) {
    order = next_order(order);
    Column column{.kind = measured.kind, .order = order, .values = measured.values, .slopes = {}};
    column.mean = std::accumulate(column.values.begin(), column.values.end(), 0.0) /
                  static_cast<double>(column.values.size());
    for (double& value : column.values) value -= column.mean;
    double largest = 0.0;
    for (const double value : column.values) largest = std::max(largest, std::abs(value));
    if (largest > 0.0) column.scale = largest;
    for (const int each : {0, order, 2 * order})
      network_.excitations.push_back({measured.kind, measured.node, each});
    if (measured.kind == ExcitationKind::motion) {
      if (time_.size() < 3)
        throw mechanics::MechanicsError("record '" + record.name +
                                        "': a measured displacement needs 3 values");
      column.slopes = spline_slopes(time_, column.values);
    }
    columns_.push_back(std::move(column));
  }
  double longest = 0.0;
  for (std::size_t i = 0; i + 1 < time_.size(); ++i) longest = std::max(longest, time_[i + 1] - time_[i]);
  omega_ = kTurned / longest;
}

NetworkValues MeasuredForcing::values_of(const NetworkValues& model) const {
  NetworkValues values = model;
  values.omega = omega_;
  values.excitation.clear();
  for (const Column& column : columns_) {
    values.excitation.push_back({column.mean, 0.0});
    values.excitation.insert(values.excitation.end(), 2, ExcitationValue{column.scale, 0.0});
  }
  return values;
}

NetworkValues MeasuredForcing::direction_of(const NetworkValues& by) const {
  NetworkValues direction = by;
  direction.omega = 0.0;
  direction.excitation.assign(network_.excitations.size(), {});
  return direction;
}

// a cos psi + p sin psi = Re (a - i p) e^{-i H} e^{i phi},  psi = phi - H
void MeasuredForcing::oscillators(std::size_t i, const std::vector<int>& orders,
                                  std::vector<std::complex<double>>& at_zero) const {
  at_zero.assign(orders.size(), 0.0);
  for (const Column& column : columns_) {
    const double rate = column.order * omega_, H = 0.5 * rate * (time_[i + 1] - time_[i]);
    const double y0 = column.values[i], y1 = column.values[i + 1];
    const Wave wave = column.kind == ExcitationKind::force
                          ? linear_wave(y0, y1, H)
                          : spline_wave(y0, y1, column.slopes[i] / rate, column.slopes[i + 1] / rate, H);
    at_zero[place_of(column.order, orders)] =
        std::complex<double>(wave.a, -wave.p) * std::polar(1.0 / column.scale, -H);
    at_zero[place_of(2 * column.order, orders)] =
        std::complex<double>(wave.c, -wave.b) * std::polar(1.0 / column.scale, -2.0 * H);
  }
}

}  // namespace frahm::identification
