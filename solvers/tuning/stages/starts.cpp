#include "solvers/tuning/stages/starts.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <stdexcept>

namespace frahm::tuning {

std::vector<double> start_point(const std::vector<Variable>& variables, std::size_t index) {
  std::vector<double> x;
  for (const Variable& v : variables) {
    if (index > 0 && !std::isfinite(v.upper - v.lower)) {
      throw std::invalid_argument("several starts need finite bounds: variable '" + v.name + "' has none");
    }
    x.push_back(std::clamp(v.start, v.lower, v.upper));
  }
  if (index == 0) return x;
  boost::random::sobol sequence(variables.size());
  sequence.discard(variables.size() * (index - 1));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double share = std::ldexp(static_cast<double>(sequence()), -64);
    x[i] = std::clamp(variables[i].lower + share * (variables[i].upper - variables[i].lower),
                      variables[i].lower, variables[i].upper);
  }
  return x;
}

}  // namespace frahm::tuning
