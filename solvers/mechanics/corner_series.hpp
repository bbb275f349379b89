#pragma once

#include <complex>
#include <span>
#include <vector>

namespace frahm::mechanics {

// A point of a course that goes in straight lines from corner to corner. Two corners at one time are a step.
struct Corner {
  double at = 0.0;     // in any unit
  double value = 0.0;  // in any unit
};

// The Fourier series of one period of such a course, up to an order:
//   value(theta) = mean + sum_n Re(harmonics[n - 1] e^(i n theta)),  theta = 2 pi at / (the period)
// in the unit of the values.
struct CornerSeries {
  double mean = 0.0;
  std::vector<std::complex<double>> harmonics;  // of the orders 1, 2, 3, ...; exactly 0 below rounding
  // The share of the root mean square of value - mean that lies in higher orders, 0 to 1; of a constant 0.
  double left_out = 0.0;
};

// corners: at least two, the first at 0, ascending, the last closes the period.  orders: >= 1.
// Each line is integrated in closed form, so every coefficient is exact, whatever the order of the cut.
CornerSeries corner_series(std::span<const Corner> corners, int orders);

}  // namespace frahm::mechanics
