#pragma once

#include "results/map_reader.hpp"
#include "results/rewording.hpp"
#include "studies/map/map_plan.hpp"

namespace frahm::studies {

// The words of a plan's study for its finished map, which was made from a study of the same fingerprint:
// units and values of axes and coordinates, of parameters and frequencies in all tables, and the points that
// failed, as --at takes them.  kept: the study of the file.
results::Rewording words_of_map(const MapPlan& plan, const Study& kept, const results::MapReader& file);

}  // namespace frahm::studies
