#pragma once

#include "tests/invariants/invariants.hpp"

namespace frahm::invariants {

// The smallest network found that violates in the same way: elements, excitations and masses are dropped, and
// values made round, one after the other, as long as the violation stays.
Case shrunk(Case large, const Violation& violation);

}  // namespace frahm::invariants
