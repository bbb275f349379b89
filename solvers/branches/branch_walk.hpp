#pragma once

#include <functional>
#include <vector>

#include "solvers/branches/special_points.hpp"

namespace frahm::periodic {

// A step along a branch, at the section of the map.
struct BranchStep {
  const BranchPlace& from;
  const BranchPlace* to;              // null where the branch ends without another place
  std::vector<SpecialPlace> special;  // between
};

// False: the branch goes on as one that is known.
using FoundOnBranch = std::function<bool(const BranchStep&)>;

// Follows a branch from a place of it, the way its tangent leads. Returns why it ends.
BranchEnd walk_branch(BranchMap& map, const BranchWanted& wanted, const BranchPlace& first,
                      const FoundOnBranch& found);

}  // namespace frahm::periodic
