#pragma once

#include <optional>

#include "solvers/branches/special_points.hpp"

namespace frahm::periodic {

// Where a branch of orbits of an even multiple of the period passes, between two of its places, through an
// orbit that takes half as long: a period doubling of those orbits, from which the branch comes and into
// which it goes back, or a stability jump of theirs at an event. Beyond it are the same orbits again, half of
// their period later.
std::optional<SpecialPlace> origin_of_doubling(BranchMap& map, const BranchPlace& from,
                                               const BranchPlace& to);

}  // namespace frahm::periodic
