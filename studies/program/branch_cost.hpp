#pragma once

#include <iosfwd>

#include "studies/map/map_plan.hpp"
#include "studies/map/map_sample.hpp"

namespace frahm::studies {

// Prints how long the branches of a study take next to its map, nothing if it asks for none: those of the row
// in the middle are followed for it, for two seconds at most, unless points of the map take so long
// themselves.
void print_branch_cost(const MapPlan& plan, const MapSample& sample, int threads, std::ostream& out);

}  // namespace frahm::studies
