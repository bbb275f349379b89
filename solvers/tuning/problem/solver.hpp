#pragma once

#include <array>
#include <string>

#include "solvers/tuning/problem/problem.hpp"

// The methods that solve a Problem, and the one function that hands it to their libraries.
namespace frahm::tuning {

enum class SolverKind {
  ipopt,   // Ipopt's interior point with a Hessian of limited memory: local, any constraints, many of them
  slsqp,   // NLopt's sequential quadratic programming: local, any constraints, dense and so for few of them
  mma,     // NLopt's moving asymptotes: local, inequalities only, many small steps that seldom fail
  mlsl,    // NLopt's SLSQP from many starts, one for each cluster of them: global, no constraints
  isres,   // NLopt's evolution strategy with ranking: global, any constraints, no derivatives
  direct,  // NLopt's division of the box into ever smaller ones: global, no constraints, no derivatives
  crs2,    // NLopt's controlled random search: global, no constraints, no derivatives
};
inline constexpr std::array kSolvers{SolverKind::ipopt, SolverKind::slsqp,  SolverKind::mma, SolverKind::mlsl,
                                     SolverKind::isres, SolverKind::direct, SolverKind::crs2};

const char* name(SolverKind kind);
// Throws std::invalid_argument for a word that is none of the names.
SolverKind solver_named(const std::string& word);

// What a method takes and uses.
struct Abilities {
  bool global = false;        // searches the whole box, which must be finite
  bool inequalities = false;  // takes constraints
  bool equalities = false;    // takes constraints with equal bounds
  bool gradients = false;     // uses derivatives
};
Abilities abilities(SolverKind kind);

// Equal calls give equal results in any thread. slsqp and mma choose their steps by values, whose rounding
// may end them at a KKT residual of 1e-9 to 1e-8: acceptable. Throws std::invalid_argument where the problem
// makes no sense (an empty interval, a scale that is not positive, a start that is not finite), for
// constraints that the method does not take and, where it is global, for an infinite bound; lets exceptions
// of the problem's functions through.
Solution solve(Problem& problem, SolverKind kind, const SolverOptions& options = {});

}  // namespace frahm::tuning
