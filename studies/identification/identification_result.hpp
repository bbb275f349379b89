#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solvers/identification/identification.hpp"
#include "solvers/transient/motion.hpp"
#include "studies/map/study_plan.hpp"

// A study of kind "identify": the solver's answer to it.
namespace frahm::studies {

struct IdentificationResult {
  std::optional<identification::Identification> first;  // the stage that the fit started from, if any
  identification::Identification fit;
};

// Throws StudyError for a value of --set that the study overrules.
StudyPlan plan_identification(Study study, std::vector<std::string> set);

// What `watch` throws is passed on. Throws StudyError for data from which nothing can be found, with the
// reason, and for a parameter that cannot take the estimate it names.
IdentificationResult identify(const Study& study, const transient::Watch& watch = {});

}  // namespace frahm::studies
