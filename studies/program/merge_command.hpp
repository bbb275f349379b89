#pragma once

#include <filesystem>
#include <iosfwd>
#include <vector>

#include "engine/progress.hpp"

namespace frahm::studies {

struct MergeOptions {
  std::filesystem::path output;
  std::vector<std::filesystem::path> logs;  // empty: all beside the output
  bool partial = false;                     // although tiles are missing; the logs are kept then
  int threads = 0;                          // >= 0; 0: engine::default_threads()
  engine::ProgressStyle progress = engine::ProgressStyle::automatic;
};

// Makes a result file from the logs of shards and prints the table of it that a run prints; where that
// is done already, says so and removes what is left of the logs. Returns 0; 3 if some points failed, 4 if
// stopped, 7 if a tuning did not converge. Throws engine::IoError, engine::ResumeRefused,
// results::StoreError.
int merge_command(const MergeOptions& options, std::ostream& out);

}  // namespace frahm::studies
