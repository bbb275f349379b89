#include "solvers/tuning/problem/problem.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "solvers/tuning/problem/scaled_problem.hpp"

namespace frahm::tuning {
namespace {

void require(bool kept, const std::string& thing, double value, const std::string& rule) {
  if (kept) return;
  std::ostringstream message;
  message << thing << " = " << value << ": " << rule;
  throw std::invalid_argument(message.str());
}

void check_scale(const std::string& thing, double scale) {
  require(scale > 0.0 && std::isfinite(scale), "scale of " + thing, scale, "must be finite and positive");
}

void check_interval(const std::string& thing, double lower, double upper) {
  require(lower < kInfinity, "lower bound of " + thing, lower, "must be a number below infinity");
  require(upper > -kInfinity, "upper bound of " + thing, upper, "must be a number above minus infinity");
  require(lower <= upper, "lower bound of " + thing, lower, "must not be above the upper bound");
}

}  // namespace

const char* name(Ending ending) {
  switch (ending) {
    case Ending::converged:
      return "converged";
    case Ending::acceptable:
      return "acceptable";
    case Ending::infeasible:
      return "infeasible";
    case Ending::iteration_limit:
      return "iteration_limit";
    case Ending::diverging:
      return "diverging";
    case Ending::failed:
      return "failed";
    case Ending::stopped:
      return "stopped";
  }
  return "";
}

void check(const Problem& problem) {
  if (problem.variables.empty()) throw std::invalid_argument("an optimisation problem needs a variable");
  check_scale("the objective", problem.objective_scale);
  for (const Variable& v : problem.variables) {
    const std::string thing = "variable '" + v.name + "'";
    check_interval(thing, v.lower, v.upper);
    check_scale(thing, v.scale);
    require(std::isfinite(v.start), "start of " + thing, v.start, "must be finite");
  }
  for (const Constraint& c : problem.constraints) {
    const std::string thing = "constraint '" + c.name + "'";
    check_interval(thing, c.lower, c.upper);
    check_scale(thing, c.scale);
  }
  for (const auto& [constraint, variable] : problem.jacobian) {
    if (constraint >= problem.constraints.size() || variable >= problem.variables.size()) {
      throw std::invalid_argument(
          "a place of the Jacobian names a constraint or variable that does not exist");
    }
  }
}

}  // namespace frahm::tuning
