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

// Its derivative. With g(c) = sqrt(L^2 - c^2) - L:  dg/dc = -c / sqrt(L^2 - c^2),  dg/dL = c^2 / (sqrt(L^2 -
// c^2) (L + sqrt(L^2 - c^2))).
double rod_part_derivative(double radius, double rod, double radius_by, double rod_by, double theta,
                           int taylor_order) {
  const double c = radius * std::cos(theta), c_by = radius_by * std::cos(theta);
  const double L2 = rod * rod;
  switch (taylor_order) {
    case 1:
      return 0.0;
    case 2:
      return -c * c_by / rod + c * c * rod_by / (2.0 * L2);
    case 4:
      return -c * c_by / rod * (1.0 + c * c / (2.0 * L2)) +
             c * c * rod_by / (2.0 * L2) * (1.0 + 3.0 * c * c / (4.0 * L2));
    default: {
      const double root = std::sqrt((rod - c) * (rod + c));
      return -c * c_by / root + c * c * rod_by / (root * (rod + root));
    }
  }
}

// The first even cosine coefficients of an even function of period pi, by the trapezoidal rule: so many
// samples over half a turn that aliasing onto the orders included is as small as the orders left out.
template <class Function>
std::vector<double> even_cosines(int count, const Function& f) {
  const int samples = 2 * count + 2 * kMostEvenOrders;
  std::vector<double> even(static_cast<std::size_t>(count) + 1, 0.0);
  for (int i = 0; i < samples; ++i) {
    const double theta = std::numbers::pi * i / samples;
    const double value = f(theta) / samples;
    for (int m = 0; m <= count; ++m) {
      even[static_cast<std::size_t>(m)] += (m == 0 ? 1.0 : 2.0) * value * std::cos(2.0 * m * theta);
    }
  }
  return even;
}

}  // namespace

double crank_displacement(double radius, double rod, double theta, int taylor_order) {
  return radius * std::sin(theta) + rod_part(radius, rod, theta, taylor_order);
}

std::vector<double> crank_even_orders(double radius, double rod, int count, int taylor_order) {
  return even_cosines(count, [&](double theta) { return rod_part(radius, rod, theta, taylor_order); });
}

std::vector<double> crank_even_orders_derivative(double radius, double rod, double radius_by, double rod_by,
                                                 int count, int taylor_order) {
  return even_cosines(count, [&](double theta) {
    return rod_part_derivative(radius, rod, radius_by, rod_by, theta, taylor_order);
  });
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
