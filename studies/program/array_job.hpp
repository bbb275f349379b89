#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// A study as a job array of a Slurm cluster.
namespace frahm::studies {

struct ArrayJob {
  std::filesystem::path study;
  std::vector<std::string> set;        // as given: name=value
  std::string noun;                    // what is shared among the tasks: "map", "tuning"
  std::uint64_t tiles = 0;             // of the job; a task has at least one
  std::optional<double> core_seconds;  // of the whole; nothing if unknown
  std::uint64_t most_tasks = 0;        // the most that one array may have
};

// The number of tasks: some ten minutes each on one core, as far as tiles and limit allow; one for each tile
// if the time is unknown. Less than 2: the job cannot be shared.
std::uint64_t tasks_of(const ArrayJob& job);

// Prints the lines that submit the job, show its progress and join its shards.
void print_array_job(const ArrayJob& job, std::ostream& out);

// MaxArraySize in what `scontrol show config` prints; nothing if it does not say.
std::optional<std::uint64_t> max_array_size_in(std::string_view configuration);

// How many tasks one array may have: MaxArraySize of the Slurm that is installed here, otherwise its default
// of 1001. (An index is below it, so tasks 0 to 1000.)
std::uint64_t most_array_tasks();

}  // namespace frahm::studies
