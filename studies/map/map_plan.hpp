#pragma once

#include <string>
#include <vector>

#include "engine/fingerprint.hpp"
#include "engine/run.hpp"
#include "solvers/periodic/quantity.hpp"
#include "studies/map/grid.hpp"
#include "studies/reading/study_file.hpp"

namespace frahm::studies {

// A study ready to be computed, kept and recorded.
struct MapPlan {
  StudyFile study;               // with the values of --set
  std::vector<std::string> set;  // as given: name=value
  Grid grid = {};
  std::vector<periodic::Quantity> quantities = {};            // of the study's own response
  std::vector<periodic::QuantityDescription> variables = {};  // those, and what a comparison adds
  engine::Fingerprint fingerprint = {};

  engine::LogHeader log_header() const { return {.fingerprint = fingerprint, .tiles = grid.tiles()}; }
};

// Throws StudyError for what stands wrong in the study, and for one that is no sweep.
MapPlan plan_map(StudyFile study, std::vector<std::string> set);

// The same of a decay or transient: a plan without a grid and without quantities.
MapPlan plan_motion(StudyFile study, std::vector<std::string> set);

// The work of a plan, which must outlive it.
engine::Job job_of(const MapPlan& plan);

}  // namespace frahm::studies
