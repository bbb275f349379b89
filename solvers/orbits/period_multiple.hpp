#pragma once

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::periodic {

// The same motion with m periods taken for one: m times the orders at a frequency m times lower.
inline mechanics::LinearSystem over_multiple(const mechanics::LinearSystem& system, int multiple) {
  mechanics::LinearSystem longer = system;
  longer.omega /= multiple;
  longer.reference_order *= multiple;
  for (int& order : longer.orders) order *= multiple;
  return longer;
}

}  // namespace frahm::periodic
