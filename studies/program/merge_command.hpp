#pragma once

#include <filesystem>
#include <iosfwd>
#include <vector>

#include "engine/progress.hpp"

namespace frahm::studies {

struct MergeOptions {
  std::filesystem::path output;
  std::vector<std::filesystem::path> logs;  // empty: all next to the output
  bool partial = false;                     // although tiles are missing; the logs stay
  int threads = 0;                          // >= 0; 0: engine::default_threads()
  engine::ProgressStyle progress = engine::ProgressStyle::automatic;
};

// Makes a result file from the logs of shards and prints the same table as a run; if the file is already
// complete, says so and removes the remaining logs. Returns 0; 3 if some points failed, 4 if stopped, 7 if a
// tuning did not converge. Throws engine::IoError, engine::ResumeRefused, results::StoreError.
int merge_command(const MergeOptions& options, std::ostream& out);

}  // namespace frahm::studies
