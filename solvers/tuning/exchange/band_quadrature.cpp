#include "solvers/tuning/exchange/band_quadrature.hpp"

#include "solvers/tuning/exchange/band_scan.hpp"

namespace frahm::tuning {
namespace {

constexpr int kPanels = 40;  // of an even grid, next to those about the poles

// Gauss-Legendre, four nodes on [0, 1] (Abramowitz and Stegun, table 25.4).
constexpr double kNodeAt[] = {0.069431844202973714, 0.33000947820757187, 0.66999052179242813,
                              0.93056815579702629};
constexpr double kNodeWeight[] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                  0.17392742256872693};

// Nodes at the shares `at` of each interval between `ends`, as a mean over them and over the scenarios.
void add_nodes(const Task& task, std::size_t scenario, const std::vector<double>& ends,
               std::span<const double> at, std::span<const double> weight,
               std::vector<QuadratureNode>& nodes) {
  const auto scenarios = static_cast<double>(task.scenarios.size());
  if (ends.size() < 2) {  // a band of one frequency
    nodes.push_back({scenario, ends.front(), 1.0 / scenarios});
    return;
  }
  const double length = ends.back() - ends.front();
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double h = ends[i + 1] - ends[i];
    for (std::size_t k = 0; k < at.size(); ++k)
      nodes.push_back({scenario, ends[i] + h * at[k], weight[k] * h / (length * scenarios)});
  }
}

}  // namespace

std::vector<QuadratureNode> pole_quadrature(const Task& task, const DesignSpace& space,
                                            const std::vector<CurveKind>& curves, std::span<const double> x) {
  std::vector<QuadratureNode> nodes;
  for (const CurveKind& curve : curves) {
    if (curve.of != CurveKind::Of::objective) continue;
    // A mean square has no leaps, so its band is one stretch.
    for (const std::vector<double>& places : places_of(task, space, curve, x, {.intervals = kPanels}))
      add_nodes(task, curve.scenario, places, kNodeAt, kNodeWeight, nodes);
  }
  return nodes;
}

std::vector<QuadratureNode> knot_quadrature(const Task& task, const DesignSpace& space,
                                            const std::vector<CurveKind>& curves) {
  constexpr double kMiddle[] = {0.5}, kWhole[] = {1.0};
  std::vector<QuadratureNode> nodes;
  for (const CurveKind& curve : curves) {
    if (curve.of == CurveKind::Of::objective)
      add_nodes(task, curve.scenario, space.knots(), kMiddle, kWhole, nodes);
  }
  return nodes;
}

}  // namespace frahm::tuning
