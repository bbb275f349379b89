#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>

#include "engine/output_lock.hpp"
#include "engine/run.hpp"
#include "results/map_reader.hpp"
#include "results/rewording.hpp"
#include "studies/program/run_command.hpp"
#include "studies/provenance/assembly_options.hpp"
#include "studies/provenance/provenance.hpp"
#include "studies/provenance/study_plan.hpp"

// Common to all runs that save their tiles in shard logs next to the output.
namespace frahm::studies {

// The effort of a run.
struct Effort {
  std::uint64_t points = 0;  // computed by it
  std::uint64_t reused = 0;  // taken over by it from an earlier result
  double seconds = 0.0;      // wall time of the whole program
  double cpu_seconds = 0.0;  // of all threads
  int threads = 0;           // of all ranks
  int ranks = 1;
};

// The steps that differ between the kinds of study.
struct LoggedWork {
  std::function<engine::Job()> job;  // the job to compute; called once, with the lock of the output held
  // Makes the file; false if it was stopped.
  std::function<bool(const RunFacts&, const AssemblyOptions&, const engine::OutputLock&)> assemble;
  // The words of the study for a finished file that was made from another text of it.  kept: that text.
  std::function<results::Rewording(const Study& kept, const results::MapReader& file)> words;
  std::function<int()> tell_what_stands;        // prints an existing file; returns the exit code
  std::function<int(const Effort&)> tell_made;  // prints a file just made
};

// Computes the missing tiles of a plan, saves them in shard logs next to the output, then makes the file.
// Returns the exit code. Throws engine::ResumeRefused, engine::Locked, engine::IoError, StudyError.
int run_in_logs(const RunCommandOptions& options, const engine::RunOptions& run, const StudyPlan& plan,
                const LoggedWork& work, std::ostream& out);

// "2 threads", "8 threads of 4 ranks".
std::string team_text(int threads, int ranks);

}  // namespace frahm::studies
