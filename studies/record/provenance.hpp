#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "results/layout.hpp"
#include "studies/record/study_plan.hpp"

// What every result file says of how it came about (results/FORMAT.md).
namespace frahm::studies {

// How a result came about.
struct RunRecord {
  std::string command;  // "frahm run rig_atlas.toml"
  int threads = 0;      // of the last run, in all ranks
  int ranks = 1;        // of it
  std::string started;  // of the last run, ISO 8601 in UTC
};

// The time now: "2026-11-21T12:34:56Z".
std::string utc_now();

// Title, source and history of a file without a map.
results::MapLayout file_layout(const StudyPlan& plan, const RunRecord& run);

// The texts of /provenance. failed: lines "<point as --at takes it>: <reason>". missing: tiles that a partial
// file does not hold.
std::vector<results::Text> provenance(const StudyPlan& plan, const RunRecord& run,
                                      const std::vector<std::string>& failed, std::uint64_t missing = 0);

}  // namespace frahm::studies
