#pragma once

#include <optional>

#include "solvers/identification/identification.hpp"

// Known values of one mass on a spring, in addition to its measured motion: they turn ratios into forces.
namespace frahm::identification {

struct OneMass {
  std::optional<double> mass;       // [kg], > 0
  std::optional<double> stiffness;  // [N/m], > 0
};

}  // namespace frahm::identification
