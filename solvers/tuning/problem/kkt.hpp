#pragma once

#include <vector>

#include "solvers/tuning/problem/problem.hpp"

// The first-order conditions of an optimum (Karush, Kuhn, Tucker), measured in the same way for every solver.
// Source: J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed., 2006, theorem 12.1.
namespace frahm::tuning {

// A problem to first order at one point, in the problem's own units.
struct Linearization {
  std::vector<double> x;  // size of variables
  double objective = 0.0;
  std::vector<double> gradient;  // size of variables
  std::vector<double> values;    // size of constraints
  std::vector<double> entries;   // size of jacobian
};

// As in Solution: L = f + sum_j constraint_j g_j + sum_i (upper_i - lower_i) x_i.
struct Multipliers {
  std::vector<double> lower, upper;  // of each variable, >= 0
  std::vector<double> constraint;    // of each constraint; > 0 at its upper bound, < 0 at its lower
};

// Largest violation of a constraint, relative to its scale.
double infeasibility(const Problem& problem, const std::vector<double>& values);

// The largest, in objective_scale, of
//   scale_i |dL/dx_i|              stationarity, of each variable
//   multiplier x slack             complementarity, of each bound of a variable or constraint
//   |multiplier| x scale           of each multiplier without a bound
double kkt_residual(const Problem& problem, const Linearization& at, const Multipliers& multipliers);

// The multipliers of the bounds near x that come nearest to the conditions above, in the sense of least
// squares.
Multipliers least_squares_multipliers(const Problem& problem, const Linearization& at);

}  // namespace frahm::tuning
