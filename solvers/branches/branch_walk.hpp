#pragma once

#include <functional>
#include <vector>

#include "solvers/branches/special_points.hpp"

namespace frahm::periodic {

// Called with each place after the first, and the special places before it.
using FoundOnBranch = std::function<void(const BranchPlace&, const std::vector<SpecialPlace>&)>;

// Follows a branch from a place of it, the way its tangent leads. Returns why it ends.
BranchEnd walk_branch(BranchMap& map, const BranchWanted& wanted, const BranchPlace& first,
                      const FoundOnBranch& found);

}  // namespace frahm::periodic
