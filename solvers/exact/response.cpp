#include "solvers/exact/response.hpp"

#include <algorithm>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::periodic {

bool have_same_elements(const mechanics::NetworkValues& a, const mechanics::NetworkValues& b) {
  return a.mass == b.mass && a.element == b.element && a.second == b.second && a.bends == b.bends &&
         a.smooth == b.smooth && a.damping == b.damping;
}

// Where one of them fails, the whole row is solved so, each point from the one before: the start that the
// failed point lacks.
void ResponseSolver::solve_rest(std::span<const mechanics::NetworkValues> points,
                                std::span<ResponseSummary> found, std::span<double> out) {
  std::vector<char> is_rest(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    is_rest[i] = found[i].status == Status::not_computed ? 1 : 0;
  std::vector<char> wanted = is_rest;
  solve_along(points, wanted, is_rest, found, out);
  if (std::ranges::count(is_rest, 1) == static_cast<std::ptrdiff_t>(points.size())) return;
  std::ranges::fill(wanted, 0);
  for (std::size_t i = 0; i < points.size(); ++i)
    wanted[i] = is_rest[i] != 0 && found[i].status == Status::failed ? 1 : 0;
  if (std::ranges::count(wanted, 1) == 0) return;
  solve_along(points, wanted, std::vector<char>(points.size(), 1), found, out);
}

// Solves those of a row that are solved, one after the other, and names those that are reported. The solver
// extrapolates over the frequency, which must change in one direction: where it turns back or pauses, a new
// row begins.
void ResponseSolver::solve_along(std::span<const mechanics::NetworkValues> points,
                                 const std::vector<char>& reported, const std::vector<char>& solved,
                                 std::span<ResponseSummary> found, std::span<double> out) {
  const std::size_t quantities = points.empty() ? 0 : out.size() / points.size();
  std::size_t points_onwards = 0;
  double omega = 0.0, direction = 0.0;
  has_last_ = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (solved[i] == 0) continue;
    if (stop_asked_ != nullptr && (*stop_asked_)()) return;
    const double step = points[i].omega - omega;
    const bool onwards = points_onwards == 1 ? step != 0.0 : step * direction > 0.0;
    if (points_onwards == 0 || !onwards) {
      begin_row();
      points_onwards = 0;
    }
    direction = step;
    omega = points[i].omega;
    ++points_onwards;
    const ResponseSummary& summary = solve_next(points[i]);
    if (reported[i] == 0) continue;
    found[i] = summary;
    if (summary.status != Status::not_computed) this->quantities(out.subspan(i * quantities, quantities));
  }
}

// Status not_computed, with the reason, where the values cannot be set.
const ResponseSummary& ResponseSolver::solve_next(const mechanics::NetworkValues& values) {
  try {
    if (has_last_ && have_same_elements(values, last_)) {
      set_forcing(values);
    } else {
      has_last_ = false;
      set_values(values);
    }
  } catch (const mechanics::MechanicsError& error) {
    has_last_ = false;
    refused_ = {};
    refused_.reason = error.what();
    return refused_;
  }
  last_ = values;
  has_last_ = true;
  return solve();
}

}  // namespace frahm::periodic
