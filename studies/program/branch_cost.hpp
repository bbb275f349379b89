#pragma once

#include <iosfwd>

#include "studies/map/map_plan.hpp"

namespace frahm::studies {

// Prints how long the branches of a study take beside its map, nothing if it asks for none: those of the row
// in the middle are followed for it, for two seconds at most.
void print_branch_cost(const MapPlan& plan, int threads, std::ostream& out);

}  // namespace frahm::studies
