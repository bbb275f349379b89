#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "solvers/mechanics/network.hpp"

// m x'' + c x' + k x + F Sgn(x') = 0 as a network, and what is known of it in closed form (DESIGN, section
// 3).
namespace frahm::transient {

struct FreeOscillator {
  double m = 1.0, k = 1.0, zeta = 0.0, x_f = 0.0;  // [kg], [N/m], [1], F/k [m]

  double natural_frequency() const { return std::sqrt(k / m); }
  double s() const { return std::sqrt(1.0 - zeta * zeta); }
  double half_period() const { return std::numbers::pi / (natural_frequency() * s()); }
  double beta() const { return std::exp(-std::numbers::pi * zeta / s()); }

  mechanics::Network network() const {
    using namespace mechanics;
    const Node ground{}, mass{NodeKind::mass, 0};
    return {.masses = {"x"},
            .elements = {{"spring", ElementType::spring, ground, mass},
                         {"damper", ElementType::damper, ground, mass},
                         {"friction", ElementType::coulomb, ground, mass}}};
  }
  mechanics::NetworkValues values() const {
    return {.mass = {m}, .element = {k, 2.0 * zeta * std::sqrt(k * m), x_f * k}};
  }

  // The turning points from a release at x_0, for zeta < 1: |x_{i+1}| = beta |x_i| - x_f (1 + beta), of a
  // sign that alternates, until the first |x_i| <= x_f, or as many as `most`. A last one that does not cross
  // zero is negative there and keeps its side.
  std::vector<double> turning_points(double x_0, std::size_t most) const {
    std::vector<double> points{x_0};
    double size = std::abs(x_0), side = x_0 > 0.0 ? 1.0 : -1.0;
    while (points.size() < most && std::abs(size) > x_f) {
      size = beta() * size - x_f * (1.0 + beta());
      side = -side;
      points.push_back(side * size);
    }
    return points;
  }
};

}  // namespace frahm::transient
