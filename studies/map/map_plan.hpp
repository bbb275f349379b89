#pragma once

#include <string>
#include <vector>

#include "engine/run.hpp"
#include "solvers/quantities/quantity.hpp"
#include "studies/map/grid.hpp"
#include "studies/record/study_plan.hpp"

namespace frahm::studies {

// A sweep ready to be computed and recorded.
struct MapPlan : StudyPlan {
  Grid grid = {};
  std::vector<periodic::Quantity> quantities = {};            // of the study's own response
  std::vector<periodic::QuantityDescription> variables = {};  // of those, and of a comparison
};

// Throws StudyError for an error in the study, and for a study that is not a sweep.
MapPlan plan_map(Study study, std::vector<std::string> set);

class KnownPoints;

// The work of a plan, which must outlive it.  earlier: the points it has are not computed; must outlive it
// too; may be null.
engine::Job job_of(const MapPlan& plan, KnownPoints* earlier = nullptr);

}  // namespace frahm::studies
