#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/log_format.hpp"
#include "engine/run.hpp"

// The progress of a job, read from the logs of its writers, whether these are at work or gone.
namespace frahm::engine {

// The shard a log belongs to by its name, <output>.shard-<i>-of-<n>.frahm-log; each rank of a shard has a log
// of its own, whose name goes on with -rank-<k>, k >= 1. Nothing for another name.
std::optional<Shard> shard_of_log(const std::filesystem::path& log);

struct WriterState {
  std::filesystem::path log;
  std::optional<Shard> shard;        // by the name of the log
  bool at_work = false;              // it held the lock of the log at the time of the survey
  std::optional<WriterStart> start;  // nothing if not in the log
};

struct Survey {
  Tally points;                        // resumed: 0
  std::vector<std::uint64_t> missing;  // tiles that are in no log, in order
  std::vector<WriterState> writers;    // one for each log of the study
  std::vector<UnusedBytes> unused;     // after the last good entry of a log
  std::optional<double> rate;          // points a second of all writers at work; nothing where unknown
  std::optional<double> seconds_left;  // at this rate
};

// Reads every entry of the logs of a job and checks the locks without keeping any. The rate of a writer is
// its points finished since it began over the wall time; it is unknown if the clock is before that start.
// logs: of this job alone.  job: its kernel is not used.  now: the time of the survey.  Throws ResumeRefused
// for a log with tiles of another study, IoError.
Survey survey(const Job& job, const std::vector<std::filesystem::path>& logs,
              std::chrono::system_clock::time_point now);

}  // namespace frahm::engine
