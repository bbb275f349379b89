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

// An array into which the work was cut.
struct TaskArray {
  std::uint64_t tasks = 0;             // > 1
  std::vector<std::uint64_t> missing;  // the tasks of which tiles are missing, ascending
};

// The arrays that have left logs, ascending by their number of tasks; several where the work was submitted
// again in another number of shards. missing: tiles that are in no log.
std::vector<TaskArray> task_arrays(std::span<const std::filesystem::path> logs,
                                   std::span<const std::uint64_t> missing);

// "; of 16 array tasks these have tiles missing: --array=3,7"; empty where there was no array.
std::string missing_tasks_text(std::span<const std::filesystem::path> logs,
                               std::span<const std::uint64_t> missing);

}  // namespace frahm::studies
