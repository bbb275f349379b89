#include "studies/program/array_job.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>

#include "engine/progress.hpp"

namespace frahm::studies {
namespace {

// A word of a shell command.
std::string shell_word(const std::string& word) {
  const auto harmless = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string_view("._-/=+,").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), harmless)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

// The output of a shell command; empty if it fails.
std::string output_of(const char* command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command, "r"), ::pclose);
  std::string text;
  std::array<char, 4096> part{};
  while (pipe && std::fgets(part.data(), part.size(), pipe.get())) text += part.data();
  return text;
}

// The shard is written out, so that a task keeps its shard when only some tasks are submitted again.
std::string run_of_task(const ArrayJob& job, const std::string& output, std::uint64_t tasks) {
  std::string run = "frahm run " + shell_word(job.study.string()) + " -o " + output;
  for (const std::string& setting : job.set) run += " --set " + shell_word(setting);
  return run + fmt::format(" --shard $SLURM_ARRAY_TASK_ID/{} --threads 1", tasks);
}

}  // namespace

std::uint64_t tasks_of(const ArrayJob& job) {
  constexpr double task_seconds = 600.0;
  const std::uint64_t most = std::min(job.most_tasks, job.tiles);
  if (most < 2 || !job.core_seconds) return most;
  const double wanted = std::ceil(*job.core_seconds / task_seconds);
  return static_cast<std::uint64_t>(std::clamp(wanted, 2.0, static_cast<double>(most)));
}

void print_array_job(const ArrayJob& job, std::ostream& out) {
  const std::uint64_t tasks = tasks_of(job);
  if (tasks < 2) {
    fmt::print(out, "\nThe {} {}.\n", job.noun,
               job.tiles < 2 ? "is a single tile, which tasks cannot share"
                             : fmt::format("cannot be shared by the {} task of an array", job.most_tasks));
    return;
  }
  const std::string output = shell_word(job.study.stem().string() + ".h5");
  fmt::print(out, "\nAs an array of {} tasks on a cluster (at most {}){}:\n", tasks, job.most_tasks,
             job.core_seconds
                 ? fmt::format(", each about {} on one core of this machine",
                               engine::readable_time(*job.core_seconds / static_cast<double>(tasks)))
                 : "");
  fmt::print(out, "  sbatch --array=0-{} --cpus-per-task=1 --wrap {}\n", tasks - 1,
             shell_word(run_of_task(job, output, tasks)));
  fmt::print(out, "  frahm status {}   # how much of the run is done, and which tasks to submit again\n",
             output);
  fmt::print(out, "  frahm merge {}    # one file from all shards\n", output);
}

std::optional<std::uint64_t> max_array_size_in(std::string_view configuration) {
  constexpr std::string_view name = "MaxArraySize";
  const std::size_t at = configuration.find(name);
  if (at == std::string_view::npos) return std::nullopt;
  std::string_view value = configuration.substr(at + name.size());
  value.remove_prefix(std::min(value.find_first_not_of(" ="), value.size()));
  std::uint64_t size = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), size);
  if (error != std::errc{}) return std::nullopt;
  return size;
}

std::uint64_t most_array_tasks() {
  constexpr std::uint64_t default_of_slurm = 1001;
  // If the controller does not answer, scontrol would wait too long.
  return max_array_size_in(output_of("timeout 5 scontrol show config 2>/dev/null"))
      .value_or(default_of_slurm);
}

}  // namespace frahm::studies
