#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>

#include "studies/program/branch_command.hpp"
#include "studies/program/check_command.hpp"
#include "studies/program/command_tree.hpp"
#include "studies/program/export_command.hpp"
#include "studies/program/merge_command.hpp"
#include "studies/program/new_command.hpp"
#include "studies/program/point_command.hpp"
#include "studies/program/report_command.hpp"
#include "studies/program/run_command.hpp"

namespace frahm::studies {

// All values that a command line can set.
struct CommandLine {
  RunCommandOptions run;
  std::string shard, time_budget, rank_silence;  // of a run, as written
  CheckOptions check;
  PointOptions point;
  BranchCommandOptions branch;
  std::filesystem::path status;
  MergeOptions merge;
  ExportOptions table;
  ReportOptions report;
  NewOptions starter;
  std::string word;   // to explain, or of which help is asked
  std::string shell;  // to complete in
  Command commands;   // all there are
  bool version = false, verbose = false;

  std::function<int(std::ostream&)> action;  // what the given command does, to its exit code
  bool is_run = false;                       // which the ranks share
};

// Reads the arguments of main() into `line`, which the action refers to. Help goes to `out`, complaints of
// wrong use to the other stream; the exit code if there is nothing more to do.
std::optional<int> parse_command_line(int argc, const char* const* argv, CommandLine& line, std::ostream& out,
                                      std::ostream& complaints);

}  // namespace frahm::studies
