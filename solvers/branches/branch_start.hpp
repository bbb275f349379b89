#pragma once

#include <vector>

#include "solvers/branches/branch_map.hpp"
#include "solvers/orbits/orbits_wanted.hpp"

namespace frahm::periodic {

// An orbit of the parameter to which the map is set, at phase 0: of a system with several the stable one that
// `frahm point` prints (the largest peak of the first mass), or of those that take `multiple` periods of the
// excitation, if that is not 0. Its status says whether one was found.
AnyOrbit find_start(BranchMap& map, int multiple);

// The stable orbits that are found at a parameter, at phase 0, in the units of the map's flow; of a system of
// one response that one. None where the values break a rule. The map must not have begun.
std::vector<AnyOrbit> find_stable(BranchMap& map, double parameter, const OrbitsWanted& wanted);

}  // namespace frahm::periodic
