#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "engine/run.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

struct RunCommandOptions {
  std::filesystem::path study;
  std::vector<std::string> set;  // name=value, a unit after the value or none
  std::filesystem::path from;    // of a map: the result to take points over from; empty: none
  std::string command;           // as typed, for the record
  engine::RunOptions run;        // output empty: the study's name with .h5, in the working directory
};

// The study's name with .h5, in the working directory.
std::filesystem::path default_output(const std::filesystem::path& study);

// Computes the result of a study, a map (run_map.hpp), an optimum (run_tuning.hpp), one motion
// or an identified model (run_at_once.hpp), writes its file and prints a short table of it. Returns 0; 3 if
// some points failed; 4 if stopped; 7 if an optimum or a fit was not found. Throws StudyError,
// engine::ResumeRefused when an output of another study is there, engine::IoError, results::StoreError.
int run_command(const RunCommandOptions& options, std::ostream& out);

// The same for a study that was read, and changed as options.set says; options.study is its name.
int run_study(const RunCommandOptions& options, Study study, std::ostream& out);

}  // namespace frahm::studies
