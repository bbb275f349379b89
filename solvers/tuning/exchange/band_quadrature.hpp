#pragma once

#include <span>
#include <vector>

#include "solvers/tuning/exchange/band_curve.hpp"

// Integrals over the band, of the objective's curves, as means over band and scenarios.
namespace frahm::tuning {

struct QuadratureNode {
  std::size_t scenario = 0;
  double at = 0.0, weight = 0.0;
};

// Gauss-Legendre nodes between points that are as close about every pole of the design x as it is wide.
std::vector<QuadratureNode> pole_quadrature(const Task& task, const DesignSpace& space,
                                            const std::vector<CurveKind>& curves, std::span<const double> x);

// The middles of the pieces of the schedules.
std::vector<QuadratureNode> knot_quadrature(const Task& task, const DesignSpace& space,
                                            const std::vector<CurveKind>& curves);

}  // namespace frahm::tuning
