#include "solvers/exact/nonstop_row.hpp"

#include <algorithm>
#include <array>

#include "solvers/orbits/orbit.hpp"

namespace frahm::periodic::nonstop {
namespace {

ResponseSummary summary_of(const Measured& measured) {
  return {.status = measured.status,
          .way = Way::event_phases,
          .reason = "",
          .residual = measured.residual,
          .newton_iterations = measured.newton_iterations,
          .half_period = measured.half_period};
}

}  // namespace

void solve_row(NonstopSolver& solver, std::span<const mechanics::NetworkValues> points,
               std::span<ResponseSummary> found, std::span<double> out) {
  if (points.empty() || !solver.set_row(points)) return;
  const std::size_t quantities = out.size() / points.size();
  std::array<std::size_t, kLanes> point_of{};
  int count = 0;
  const auto solve_lanes = [&] {
    if (count == 0) return;
    solver.solve(count);
    for (int lane = 0; lane < count; ++lane) {
      const std::size_t i = point_of[static_cast<std::size_t>(lane)];
      if (!solver.is_found(lane)) continue;
      if (solver.quantities(lane, out.subspan(i * quantities, quantities)))
        found[i] = summary_of(solver.measured());
    }
    count = 0;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!solver.set_point(count, points[i])) continue;
    point_of[static_cast<std::size_t>(count++)] = i;
    if (count == kLanes) solve_lanes();
  }
  solve_lanes();
}

}  // namespace frahm::periodic::nonstop
