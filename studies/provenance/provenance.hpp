#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "results/layout.hpp"
#include "studies/provenance/study_plan.hpp"

// The origin of a result, as every result file records it (results/FORMAT.md).
namespace frahm::studies {

// The run that made a result.
struct RunFacts {
  std::string command;  // "frahm run rig_atlas.toml"
  int threads = 0;      // of the last run, in all ranks
  int ranks = 1;        // of the last run
  std::string started;  // of the last run, ISO 8601 in UTC
};

// The time now: "2026-11-21T12:34:56Z".
std::string utc_now();

// Title, source and history of a file without a map.
results::MapLayout file_layout(const StudyPlan& plan, const RunFacts& run);

// Its overrides in /provenance.
std::string overrides_text(const std::vector<std::string>& set);

// The texts of /provenance of a finished result, with this study in place of the one that it was made from,
// which has the same fingerprint. changed: further texts that are to change.
std::vector<results::Text> provenance_in_words(std::vector<results::Text> texts, const StudyPlan& plan,
                                               const std::vector<results::Text>& changed);

// The texts of /provenance. failed: lines "<point as --at takes it>: <reason>". missing: number of tiles
// missing from a partial file.
std::vector<results::Text> provenance(const StudyPlan& plan, const RunFacts& run,
                                      const std::vector<std::string>& failed, std::uint64_t missing = 0);

}  // namespace frahm::studies
