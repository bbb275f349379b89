#include "solvers/tuning/problem/solver.hpp"

#include <stdexcept>

#include "solvers/tuning/problem/ipopt.hpp"
#include "solvers/tuning/problem/nlopt.hpp"
#include "solvers/tuning/problem/scaled_problem.hpp"

namespace frahm::tuning {
namespace {

std::string names_of(bool Abilities::*ability) {
  std::string names;
  for (const SolverKind kind : kSolvers) {
    if (abilities(kind).*ability) names += (names.empty() ? "" : ", ") + std::string(name(kind));
  }
  return names;
}

void check_fit(const Problem& problem, SolverKind kind) {
  const Abilities able = abilities(kind);
  const std::string solver = "solver '" + std::string(name(kind)) + "'";
  for (const Constraint& c : problem.constraints) {
    const bool equality = c.lower == c.upper;
    if (equality ? able.equalities : able.inequalities) continue;
    throw std::invalid_argument(solver + " does not accept " + (equality ? "equality " : "") +
                                "constraints, such as '" + c.name + "'; solvers that do are " +
                                names_of(equality ? &Abilities::equalities : &Abilities::inequalities));
  }
  if (!able.global) return;
  for (const Variable& v : problem.variables) {
    if (v.lower > -kInfinity && v.upper < kInfinity) continue;
    throw std::invalid_argument(solver + " searches a finite box: variable '" + v.name +
                                "' has an infinite bound");
  }
}

}  // namespace

const char* name(SolverKind kind) {
  switch (kind) {
    case SolverKind::ipopt:
      return "ipopt";
    case SolverKind::slsqp:
      return "slsqp";
    case SolverKind::mma:
      return "mma";
    case SolverKind::mlsl:
      return "mlsl";
    case SolverKind::isres:
      return "isres";
    case SolverKind::direct:
      return "direct";
    case SolverKind::crs2:
      return "crs2";
  }
  return "";
}

SolverKind solver_named(const std::string& word) {
  std::string known;
  for (const SolverKind kind : kSolvers) {
    if (word == name(kind)) return kind;
    known += (known.empty() ? "" : ", ") + std::string(name(kind));
  }
  throw std::invalid_argument("solver '" + word + "' is not one of " + known);
}

Abilities abilities(SolverKind kind) {
  switch (kind) {
    case SolverKind::ipopt:
    case SolverKind::slsqp:
      return {.inequalities = true, .equalities = true, .gradients = true};
    case SolverKind::mma:
      return {.inequalities = true, .gradients = true};
    case SolverKind::mlsl:
      return {.global = true, .gradients = true};
    case SolverKind::isres:
      return {.global = true, .inequalities = true, .equalities = true};
    case SolverKind::direct:
    case SolverKind::crs2:
      return {.global = true};
  }
  return {};
}

Solution solve(Problem& problem, SolverKind kind, const SolverOptions& options) {
  check(problem);
  check_fit(problem, kind);
  return kind == SolverKind::ipopt ? solve_with_ipopt(problem, options)
                                   : solve_with_nlopt(problem, kind, options);
}

}  // namespace frahm::tuning
