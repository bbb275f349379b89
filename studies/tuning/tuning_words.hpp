#pragma once

#include "results/rewording.hpp"
#include "studies/provenance/study_plan.hpp"

namespace frahm::studies {

// The words of a plan's study for its finished tuning, which was made from a study of the same fingerprint:
// the units in which designs, limits, columns and the band are given.  kept: the study of the file.
results::Rewording words_of_tuning(const StudyPlan& plan, const Study& kept);

}  // namespace frahm::studies
