#pragma once

#include <optional>

#include "solvers/identification/identification.hpp"

// From ratios to newtons: what is known of one mass on a spring beside its measured motion.
namespace frahm::identification {

struct OneMass {
  std::optional<double> mass;       // [kg], > 0
  std::optional<double> stiffness;  // [N/m], > 0
};

}  // namespace frahm::identification
