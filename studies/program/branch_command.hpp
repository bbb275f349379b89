#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "engine/progress.hpp"

namespace frahm::studies {

struct BranchCommandOptions {
  std::filesystem::path study;
  std::string along;                              // a parameter of the study that is a number
  std::optional<std::string> from = {}, to = {};  // of it, a unit after the value or none; otherwise its axis
  std::vector<std::string> at = {};               // of other parameters; of `along`: where to start
  std::vector<std::string> set = {};              // applied to the study before
  int steps = 2000;                               // most points each way
  int multiple = 0;                               // of the excitation's period; 0: any
  std::optional<std::filesystem::path> output = {};  // of all points: CSV, or a result where it ends in .h5
  bool fresh = false;                                // replace another result that is there
  std::string command = {};                          // for the result's history
  engine::ProgressStyle progress = engine::ProgressStyle::automatic;
};

// Follows the branch of the periodic response along a parameter, stable and unstable, through its folds;
// prints the special points. An interrupted one leaves no file. Returns 0, or 3 where there is no response to
// start from. Throws StudyError for a wrong study, name or value; engine::ResumeRefused for another result at
// the output, which an earlier one of the same branch is not; engine::IoError for a file that cannot be
// written.
int branch_command(const BranchCommandOptions& options, std::ostream& out);

}  // namespace frahm::studies
