#pragma once

#include "solvers/mechanics/network.hpp"

namespace frahm::mechanics {

// The mean of the values of one network at two points.
NetworkValues halfway(const NetworkValues& a, const NetworkValues& b);

}  // namespace frahm::mechanics
