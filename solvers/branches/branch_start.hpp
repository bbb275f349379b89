#pragma once

#include "solvers/branches/branch_map.hpp"

namespace frahm::periodic {

// An orbit of the parameter to which the map is set, at phase 0: of a system with several the stable one that
// `frahm point` tells (the largest peak of the first mass), or of those that take `multiple` periods of the
// excitation, if that is not 0. Its status says whether one was found.
AnyOrbit find_start(BranchMap& map, int multiple);

}  // namespace frahm::periodic
