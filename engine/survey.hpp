#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/log_format.hpp"
#include "engine/run.hpp"

// How far a job is, seen from outside: by the logs its writers have left, whether they are at work or gone.
namespace frahm::engine {

// The shard a log belongs to by its name, <output>.shard-<i>-of-<n>.frahm-log; each rank of a shard has a log
// of its own, whose name goes on with -rank-<k>, k >= 1. Nothing for another name.
std::optional<Shard> shard_of_log(const std::filesystem::path& log);

struct WriterState {
  std::filesystem::path log;
  std::optional<Shard> shard;        // by the name of the log
  bool at_work = false;              // it held the lock of the log when this was asked
  std::optional<WriterStart> start;  // nothing if the log does not say
};

struct Survey {
  Tally points;                        // resumed: 0
  std::vector<std::uint64_t> missing;  // tiles that are in no log, in order
  std::vector<WriterState> writers;    // one for each log of the study
  std::vector<UnusedBytes> unused;     // behind the last good record of a log
  std::optional<double> rate;          // points a second of all writers at work; nothing where unknown
  std::optional<double> seconds_left;  // at this rate
};

// Reads every record of the logs of a job and looks at the locks, and keeps none. The rate of a writer is
// what it has finished since it began, by the wall clock; a clock that stands before that beginning makes it
// unknown. logs: of this job alone.  job: its kernel is not used.  now: the time of the survey.  Throws
// ResumeRefused for a log that keeps tiles of another study, IoError.
Survey survey(const Job& job, const std::vector<std::filesystem::path>& logs,
              std::chrono::system_clock::time_point now);

}  // namespace frahm::engine
