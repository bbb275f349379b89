#pragma once

#include "solvers/tuning/problem/problem.hpp"

// The adapter to Ipopt; callers use solve() (solver.hpp).
namespace frahm::tuning {

// Interior-point method with exact gradients and a limited-memory Hessian. Re-entrant: solves in several
// threads take turns inside Ipopt, whose linear solver is not thread-safe, and run side by side in the
// problem's functions. Source: A. Waechter, L. T. Biegler, Math. Program. 106 (2006) 25-57.
Solution solve_with_ipopt(Problem& problem, const SolverOptions& options);

}  // namespace frahm::tuning
