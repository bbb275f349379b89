#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/fingerprint.hpp"
#include "studies/provenance/study_plan.hpp"

namespace frahm::studies {

// A line for each change, of many the first.
std::string lines_of_changes(const std::vector<std::string>& changes);

// What has changed since the result or the logs that are in the way of a run were made, a line for each, and
// below it what to do; advice "": that which fits any other study.
std::string refusal_advice(const std::vector<std::string>& changes, const std::string& advice = "");

// Throws engine::ResumeRefused if there is a result at the output that is not of this plan.
void refuse_another_result(const std::filesystem::path& output, const StudyPlan& plan);

// What has changed since the logs in the way of a run were made; none where the note of their study is not
// next to them.
std::vector<std::string> changes_since_logs(const engine::ResumeRefused& refused, const Study& now,
                                            const std::filesystem::path& output);

// The logs that a stopped run left next to an output, for a study that makes none: they would be in the way
// of that run's resumption. They are refused, by engine::ResumeRefused, or discarded with the notes of their
// studies. Throws engine::IoError, engine::Locked.
void make_room_beside(const std::filesystem::path& output, const StudyPlan& plan, bool fresh);

}  // namespace frahm::studies
