#pragma once

#include "solvers/mechanics/network.hpp"

namespace frahm::mechanics {

// sum += factor values. Both are laid out alike, but that `sum` may lack bends, which count as zeros. The
// numbers of smooth laws are not added.
void add(const NetworkValues& values, double factor, NetworkValues& sum);

}  // namespace frahm::mechanics
