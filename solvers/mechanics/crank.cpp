#include "solvers/mechanics/crank.hpp"

#include <cmath>
#include <numbers>

namespace frahm::mechanics {
namespace {

// The rod's part of the displacement, without cancellation: sqrt(L^2 - c^2) - L = -c^2 / (L + sqrt(L^2 -
// c^2)).
double rod_part(double radius, double rod, double theta, int taylor_order) {
  const double c = radius * std::cos(theta);
  switch (taylor_order) {
    case 1:
      return 0.0;
    case 2:
      return -c * c / (2.0 * rod);
    case 4:
      return -c * c / (2.0 * rod) - c * c * c * c / (8.0 * rod * rod * rod);
    default:
      return -c * c / (rod + std::sqrt((rod - c) * (rod + c)));
  }
}

}  // namespace

double crank_displacement(double radius, double rod, double theta) {
  return radius * std::sin(theta) + rod_part(radius, rod, theta, 0);
}

std::vector<double> crank_even_orders(double radius, double rod, int count, int taylor_order) {
  // Samples over half a turn, enough that what folds back onto the orders kept is as small as what is cut.
  const int samples = 2 * count + 2 * kMostEvenOrders;
  std::vector<double> even(static_cast<std::size_t>(count) + 1, 0.0);
  for (int i = 0; i < samples; ++i) {
    const double theta = std::numbers::pi * i / samples;
    const double value = rod_part(radius, rod, theta, taylor_order) / samples;
    for (int m = 0; m <= count; ++m) {
      even[static_cast<std::size_t>(m)] += (m == 0 ? 1.0 : 2.0) * value * std::cos(2.0 * m * theta);
    }
  }
  return even;
}

int crank_orders_needed(double ratio) {
  // cos(2 m theta) falls like q^m, q = (1 - s)/(1 + s), s = sqrt(1 - ratio^2): the branch point nearest the
  // real angles is where cos(theta) = 1/ratio.
  const double s = std::sqrt(1.0 - ratio * ratio), q = (1.0 - s) / (1.0 + s);
  double size = ratio;
  int needed = 1;
  for (; needed < kMostEvenOrders && size > 1e-15; ++needed) size *= q;
  return needed;
}

}  // namespace frahm::mechanics
