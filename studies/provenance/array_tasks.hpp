#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

// The tasks of a job array, each of which computes one shard: --shard $SLURM_ARRAY_TASK_ID/n.
namespace frahm::studies {

// Numbers as `sbatch --array` takes them: "0-3,7,9-15".  numbers: ascending, each once.
std::string array_list(std::span<const std::uint64_t> numbers);

// A job array among whose tasks the work was divided.
struct TaskArray {
  std::uint64_t tasks = 0;             // > 1
  std::vector<std::uint64_t> missing;  // tasks with missing tiles, ascending
};

// The arrays that have left logs, ascending by their number of tasks; several if the work was submitted again
// with another number of shards. missing: tiles that are in no log.
std::vector<TaskArray> task_arrays(std::span<const std::filesystem::path> logs,
                                   std::span<const std::uint64_t> missing);

// "; of 16 array tasks these have tiles missing: --array=3,7"; empty without an array.
std::string missing_tasks_text(std::span<const std::filesystem::path> logs,
                               std::span<const std::uint64_t> missing);

}  // namespace frahm::studies
