#pragma once

#include <filesystem>
#include <iosfwd>

#include "studies/program/run_command.hpp"
#include "studies/provenance/study_plan.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/tuning/tuning_result.hpp"

namespace frahm::studies {

// Computes a study of kind "tune", or its missing starts, writes its file and prints the optimum. Returns 0;
// 4 if stopped; 7 if it did not converge, with the best design so far in the file. Throws as run_command().
int run_tuning(const RunCommandOptions& options, Study study, std::ostream& out);

// Prints the tuning just written; if it is not an optimum, prints the reason on stderr. Returns 0 or 7.
int tell_tuning(const StudyPlan& plan, const TuningResult& result, const std::filesystem::path& file,
                std::ostream& out);

}  // namespace frahm::studies
