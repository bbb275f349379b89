#pragma once

#include "solvers/tuning/problem/solver.hpp"

// The adapter to NLopt; callers use solve() (solver.hpp).
namespace frahm::tuning {

// For every kind but ipopt. solve() has checked that the problem fits the method.
Solution solve_with_nlopt(Problem& problem, SolverKind kind, const SolverOptions& options);

}  // namespace frahm::tuning
