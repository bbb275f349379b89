#include "studies/provenance/array_tasks.hpp"

#include <fmt/format.h>

#include <set>

#include "engine/survey.hpp"

namespace frahm::studies {

std::string array_list(std::span<const std::uint64_t> numbers) {
  std::string list;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    if (!list.empty()) list += ',';
    list += fmt::format("{}", numbers[i]);
    if (last > i) list += fmt::format("-{}", numbers[last]);
    i = last + 1;
  }
  return list;
}

std::vector<TaskArray> task_arrays(std::span<const std::filesystem::path> logs,
                                   std::span<const std::uint64_t> missing) {
  std::set<std::uint64_t> counts;
  for (const auto& log : logs) {
    const auto shard = engine::shard_of_log(log);
    if (shard && shard->count > 1) counts.insert(shard->count);
  }
  std::vector<TaskArray> arrays;
  for (const std::uint64_t count : counts) {
    std::set<std::uint64_t> tasks;
    for (const std::uint64_t tile : missing) tasks.insert(tile % count);
    arrays.push_back({count, {tasks.begin(), tasks.end()}});
  }
  return arrays;
}

std::string missing_tasks_text(std::span<const std::filesystem::path> logs,
                               std::span<const std::uint64_t> missing) {
  std::string text;
  for (const TaskArray& array : task_arrays(logs, missing)) {
    text += fmt::format("{} {} array tasks these have tiles missing: --array={}",
                        text.empty() ? "; of" : ", or of", array.tasks, array_list(array.missing));
  }
  return text;
}

}  // namespace frahm::studies
