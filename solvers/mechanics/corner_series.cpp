#include "solvers/mechanics/corner_series.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace frahm::mechanics {
namespace {

constexpr double kCoefficientRounding = 1e-14;  // of the largest distance from the mean

// (sin x - x cos x)/x^2; for small x its Taylor series, whose next term is below 1e-16 of it.
double odd_part(double x) {
  if (std::abs(x) > 0.25) return (std::sin(x) - x * std::cos(x)) / (x * x);
  const double y = x * x;
  return x / 3.0 *
         (1.0 - y / 10.0 * (1.0 - y / 28.0 * (1.0 - y / 54.0 * (1.0 - y / 88.0 * (1.0 - y / 130.0)))));
}

double even_part(double x) {
  return x == 0.0 ? 1.0 : std::sin(x) / x;
}

// e^(-i 2 pi turns), whole turns left out before anything is rounded.
std::complex<double> turned_back(double turns) {
  return std::polar(1.0, -2.0 * std::numbers::pi * std::remainder(turns, 1.0));
}

// A straight line over a part of the period, in periods.
struct Line {
  double middle = 0.0, length = 0.0;
  double value = 0.0, rise = 0.0;  // at its middle, and over its length
};

std::vector<Line> lines_between(std::span<const Corner> corners) {
  const double period = corners.back().at;
  std::vector<Line> lines;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Corner &a = corners[i], &b = corners[i + 1];
    if (b.at > a.at)
      lines.push_back({.middle = 0.5 * (a.at + b.at) / period,
                       .length = (b.at - a.at) / period,
                       .value = 0.5 * (a.value + b.value),
                       .rise = b.value - a.value});
  }
  return lines;
}

// 2 int f e^(-i 2 pi n t) dt over the period, the sum over all lines of length h about their middles m:
//   int = h e^(-i 2 pi n m) (f_m sin(x)/x - i (rise/2) (sin x - x cos x)/x^2),   x = pi n h
std::complex<double> coefficient(std::span<const Line> lines, int order) {
  std::complex<double> sum = 0.0;
  for (const Line& line : lines) {
    const double x = std::numbers::pi * order * line.length;
    sum += line.length * turned_back(order * line.middle) *
           std::complex<double>(line.value * even_part(x), -0.5 * line.rise * odd_part(x));
  }
  return 2.0 * sum;
}

}  // namespace

CornerSeries corner_series(std::span<const Corner> corners, int orders) {
  std::vector<Line> lines = lines_between(corners);
  CornerSeries series;
  for (const Line& line : lines) series.mean += line.length * line.value;
  // int f^2 dt of a line = h (f_m^2 + rise^2/12)
  double largest = 0.0, square = 0.0;
  for (Line& line : lines) {
    line.value -= series.mean;
    largest = std::max(largest, std::abs(line.value) + 0.5 * std::abs(line.rise));
    square += line.length * (line.value * line.value + line.rise * line.rise / 12.0);
  }
  if (std::abs(series.mean) <= kCoefficientRounding * largest) series.mean = 0.0;
  double kept = 0.0;  // sum |c_n|^2/2 is their mean square (Parseval)
  for (int n = 1; n <= orders; ++n) {
    std::complex<double> c = coefficient(lines, n);
    if (std::abs(c) <= kCoefficientRounding * largest) c = 0.0;
    series.harmonics.push_back(c);
    kept += 0.5 * std::norm(c);
  }
  if (square > 0.0) series.left_out = std::sqrt(std::max(0.0, 1.0 - kept / square));
  return series;
}

}  // namespace frahm::mechanics
