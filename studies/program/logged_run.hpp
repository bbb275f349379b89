#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "engine/run.hpp"
#include "engine/stop_request.hpp"
#include "studies/map/study_plan.hpp"

// What runs have in common whose tiles are kept in shard logs beside the output.
namespace frahm::studies {

// Removes what an earlier run that was killed between writing the file and removing its logs has left.
void remove_leftovers(const StudyPlan& plan, const std::filesystem::path& output);

// Whether the file is there already, and is that of this study. Throws engine::ResumeRefused for another's.
bool is_finished(const StudyPlan& plan, const std::filesystem::path& output);

// Computes what is left of a plan's job, with the note of its study beside the logs. Throws as engine::run().
engine::Summary compute(const StudyPlan& plan, const engine::Job& job, const engine::RunOptions& run);

// Notes, on stderr, what could not be used of earlier logs.
void tell_unused(const engine::Summary& summary);

// "2 threads", "8 threads of 4 ranks".
std::string team_text(int threads, int ranks);

// The ends of a run that makes no file: stopped while it computed, or while the file was made; one shard of
// several. They return the exit code.
int tell_stopped(const engine::Summary& summary, const std::filesystem::path& output);
int tell_unwritten(const engine::StopRequest& stop, const std::filesystem::path& output);
int tell_shard(const engine::RunOptions& run, const engine::Summary& summary, std::ostream& out);

}  // namespace frahm::studies
