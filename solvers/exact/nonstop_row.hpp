#pragma once

#include <span>

#include "solvers/exact/response.hpp"
#include "solvers/nonstop/nonstop_solver.hpp"

namespace frahm::periodic::nonstop {

// Solves those points of a row on which nothing sticks, side by side. The others keep the status
// not_computed; so do all where masses or elements change along the row, as their modes would cost more than
// the orbits. found, out: as of PeriodicResponse::solve_row().
void solve_row(NonstopSolver& solver, std::span<const mechanics::NetworkValues> points,
               std::span<ResponseSummary> found, std::span<double> out);

}  // namespace frahm::periodic::nonstop
