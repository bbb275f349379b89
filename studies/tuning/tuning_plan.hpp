#pragma once

#include <string>
#include <vector>

#include "engine/run.hpp"
#include "solvers/tuning/optimum.hpp"
#include "studies/provenance/study_plan.hpp"

namespace frahm::studies {

// A study of kind "tune" ready to be computed: a tile is one start, its record the optima found from it.
// Throws StudyError for names that clash in the record, and for --set of values that the study overrides.
StudyPlan plan_tuning(Study study, std::vector<std::string> set);

// The optima found from one start, one for each limit of a trade-off. Throws StudyError for an invalid task.
std::vector<tuning::Optimum> tune_start(const Study& study, const tuning::Task& task, std::size_t start,
                                        const engine::StopAsked& stop_asked);

// The work of such a plan, which must outlive it. A start that is asked to stop is given up. Its kernels
// throw StudyError for an invalid task.
engine::Job job_of_tuning(const StudyPlan& plan);

}  // namespace frahm::studies
