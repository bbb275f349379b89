#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "solvers/algebra/no_value.hpp"

// An optimisation problem in plain terms (solved in solver.hpp):
//
//   minimise f(x)   subject to   lower_i <= x_i <= upper_i,   lower_j <= g_j(x) <= upper_j
//
// Bounds may be infinite; equal bounds make a constraint an equality, and bounds with no more than rounding
// between them fix a variable.
namespace frahm::tuning {

// Whether bounds are one value but for some ten roundings of it. In a scale of its own range such a variable
// would be the number 1e14 and more.
inline bool are_one_value(double lower, double upper) {
  constexpr double kRounding = 1e-14;
  const double size = std::max(std::abs(lower), std::abs(upper));
  return lower == upper || (std::isfinite(size) && upper - lower <= kRounding * size);
}

struct Variable {
  std::string name;
  double lower = -kInfinity, upper = kInfinity;
  double start = 0.0;  // moved to the nearer bound where it is outside
  double scale = 1.0;  // typical size, > 0: the solvers work in x / scale
};

struct Constraint {
  std::string name;
  double lower = -kInfinity, upper = kInfinity;
  double scale = 1.0;  // typical size of its values, > 0
};

// Position of one derivative d g_constraint / d x_variable that may differ from zero.
struct JacobianEntry {
  std::size_t constraint = 0, variable = 0;
};

// What is to be minimised. The lists are fixed during a solve. A point may be requested first without and
// then with derivatives. Exceptions of the functions end the solve and are passed on.
class Problem {
 public:
  virtual ~Problem() = default;

  std::vector<Variable> variables;
  std::vector<Constraint> constraints;
  std::vector<JacobianEntry> jacobian;  // structure, each position once
  double objective_scale = 1.0;         // typical size of the objective, > 0

  // Objective at x (size of variables); its gradient (the same size) is filled unless empty.
  // May return NaN: not defined there. The solvers then take a shorter step.
  virtual double objective(std::span<const double> x, std::span<double> gradient) = 0;

  // Constraint values (size of constraints); derivatives (size of jacobian, in its order) are filled unless
  // empty. NaN as above.
  virtual void constrain(std::span<const double> x, std::span<double> values, std::span<double> entries) = 0;

  // Called at every evaluation: true ends the solve with the best point so far.
  virtual bool stop_asked() { return false; }
};

// How a solve ended. Our KKT residual decides the first two, regardless of what the library reports.
enum class Ending {
  converged,        // KKT residual within the tolerance, constraints within the feasibility
  acceptable,       // feasible, and the KKT residual within kAcceptable tolerances
  infeasible,       // no feasible point was found; x is where the constraints are violated least
  iteration_limit,  // the iterations allowed were used up; the normal ending of a global search
  diverging,        // the objective falls, or x grows, without limit
  failed,           // the library could not go on, see the reason
  stopped,          // stop_asked
};
inline constexpr double kAcceptable = 1e3;
const char* name(Ending ending);

struct Iteration {
  int iteration = 0;
  double objective = 0.0;
  double infeasibility = 0.0;
  double optimality = 0.0;  // Ipopt's dual infeasibility, NLopt: our KKT residual; NaN: not looked at
};

// Multipliers are those of L = f + sum lambda_j g_j + sum (upper_i - lower_i multiplier) x_i, so that
//   d f* / d (bound of constraint j)     = -constraint_multipliers[j]   (> 0: upper bound active, < 0: lower)
//   d f* / d (upper bound of variable i) = -upper_multipliers[i]
//   d f* / d (lower bound of variable i) = +lower_multipliers[i]
struct Solution {
  Ending ending = Ending::failed;
  std::string reason;          // a sentence: why the solve ended
  std::vector<double> x;       // size of variables: the optimum, otherwise the best feasible point met
  double objective = 0.0;      // at x
  double kkt_residual = 0.0;   // of kkt.hpp, by the same computation for every solver; NaN: no gradient at x
  double infeasibility = 0.0;  // largest violation of a constraint, relative to its scale
  std::vector<double> lower_multipliers, upper_multipliers;  // of each variable, >= 0
  std::vector<double> constraint_multipliers;                // of each constraint
  int iterations = 0;   // of NLopt's algorithms: improvements of the best point
  int evaluations = 0;  // points at which objective and constraints were evaluated
  std::vector<Iteration> history;
};

struct SolverOptions {
  double tolerance = 1e-9;     // of the KKT residual
  int most_iterations = 500;   // a global algorithm may use 10 (variables + 1) evaluations for each
  double feasibility = 1e-10;  // largest violation of a constraint, relative to its scale
};

}  // namespace frahm::tuning
