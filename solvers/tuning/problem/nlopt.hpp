#pragma once

#include "solvers/tuning/problem/solver.hpp"

// The adapter to NLopt; who has a problem calls solve() (solver.hpp).
namespace frahm::tuning {

// Every kind but ipopt. The problem fits the method: solve() has looked.
Solution solve_with_nlopt(Problem& problem, SolverKind kind, const SolverOptions& options);

}  // namespace frahm::tuning
