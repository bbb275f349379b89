#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/record/study_plan.hpp"

namespace frahm::studies {

// What has changed since the result or the logs that are in the way of a run were made, a line for each, and
// below it what to do; advice "": that which fits any other study.
std::string refusal_advice(const std::vector<std::string>& changes, const std::string& advice = "");

// Throws engine::ResumeRefused if there is a result at the output that is not of this plan.
void refuse_another_result(const std::filesystem::path& output, const StudyPlan& plan);

}  // namespace frahm::studies
