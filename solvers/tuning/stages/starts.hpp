#pragma once

#include <cstddef>
#include <vector>

#include "solvers/tuning/problem/problem.hpp"

namespace frahm::tuning {

// Start number `index` of a multi-start: 0 is the variables' own start, the others a Sobol sequence, which
// fills the box of their bounds evenly. Every start can be made alone. Throws std::invalid_argument for index
// > 0 where a bound is infinite. Source: S. Joe, F. Y. Kuo, SIAM J. Sci. Comput. 30 (2008) 2635.
std::vector<double> start_point(const std::vector<Variable>& variables, std::size_t index);

}  // namespace frahm::tuning
