#pragma once

#include <string>
#include <vector>

#include "engine/run.hpp"
#include "solvers/quantities/quantity.hpp"
#include "solvers/transient/motion_quantity.hpp"
#include "studies/map/grid.hpp"
#include "studies/provenance/study_plan.hpp"

namespace frahm::studies {

// A map ready to be computed and recorded: of the responses of a sweep, or of motions.
struct MapPlan : StudyPlan {
  Grid grid = {};
  std::vector<periodic::Quantity> quantities = {};                // of a sweep's own response
  std::vector<transient::MotionQuantity> motion_quantities = {};  // of a motion
  std::vector<periodic::QuantityDescription> variables = {};      // of those, and of a comparison

  // The first of the variables are those of the study's own response or motion.
  std::size_t own_variables() const { return quantities.size() + motion_quantities.size(); }
};

// Throws StudyError for an error in the study, for a study without axes and for more than 16 million tiles.
MapPlan plan_map(Study study, std::vector<std::string> set);

class KnownPoints;

// The work of a plan, which must outlive it.  earlier: the points it has are not computed; must outlive it
// too; may be null.
engine::Job job_of(const MapPlan& plan, KnownPoints* earlier = nullptr);

}  // namespace frahm::studies
