#pragma once

#include "studies/map/map_plan.hpp"

namespace frahm::studies {

// Refuses a study whose axes have names that the groups of its samples need (/statistics, /tornado). Throws
// StudyError at the axis.
void check_sample_names(const MapPlan& plan);

}  // namespace frahm::studies
