#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

// The rig of tune_rig_*.toml without friction, in closed form, and the best schedule of its inertance by a
// fine grid. Written apart from the engine, so that the two check each other.
namespace linear_rig {

// Amplitude of the main mass [m].  omega: [rad/s].  I: inertance [kg].  k: stiffness of the absorber [N/m].
inline double main_peak(double omega, double I, double k) {
  using Complex = std::complex<double>;
  constexpr double M = 102.66, m = 12.82, C = 1.7688, K = 8181.0, A = 0.02955;
  const double c = 26.5104 + 0.4811 * I;
  // Between the masses: D = k + i omega c - omega^2 I.  (D - omega^2 m) y = D x.
  const Complex D(k - omega * omega * I, omega * c);
  const Complex absorber = -omega * omega * m * D / (D - omega * omega * m);
  return std::abs(K * A / (Complex(7.0 * K - omega * omega * M, omega * C) + absorber));
}

// Least worst peak of all paths I(omega) over a grid of 15 .. 35 rad/s and 4.72 .. 12.9 kg, no steeper than
// 2 kg per rad/s; with a leap at one of the places, where both its sides count.
// places: pieces of the band. Four columns are as wide as a piece may climb.
inline double best_schedule(double k, int places, bool may_leap) {
  const double step = 20.0 / places, column = 2.0 * step / 4.0;
  const int columns = static_cast<int>((12.9 - 4.72) / column) + 1;
  // The last column is the upper bound, a little beyond an even grid.
  const auto level = [&](int j) { return j == columns ? 12.9 : 4.72 + column * j; };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> before(static_cast<std::size_t>(columns) + 1, 0.0), after = before;
  std::ranges::fill(after, infinity);
  for (int i = 0; i <= places; ++i) {
    std::vector<double> next(before.size()), next_after(before.size());
    for (int j = 0; j <= columns; ++j) {
      double least = infinity, least_after = infinity;
      for (int from = std::max(0, j - 4); from <= std::min(columns, j + 4); ++from) {
        least = std::min(least, before[static_cast<std::size_t>(from)]);
        least_after = std::min(least_after, after[static_cast<std::size_t>(from)]);
      }
      const double height = main_peak(15.0 + step * i, level(j), k);
      next[static_cast<std::size_t>(j)] = std::max(least, height);
      next_after[static_cast<std::size_t>(j)] = std::max(least_after, height);
    }
    if (may_leap) {
      const double least = *std::ranges::min_element(next);
      for (int j = 0; j <= columns; ++j)
        next_after[static_cast<std::size_t>(j)] =
            std::min(next_after[static_cast<std::size_t>(j)],
                     std::max(least, main_peak(15.0 + step * i, level(j), k)));
    }
    before = next;
    after = next_after;
  }
  return std::min(*std::ranges::min_element(before), *std::ranges::min_element(after));
}

}  // namespace linear_rig
