// What keeping a map costs, beside computing it: the shard log while the tiles are computed, and the assembly
// of the result file from it. Every figure from one run of the engine and the assembly as the program calls
// them.
//
//   benchmark_writing [FOLDER]   writes some 2 GB in FOLDER, else in the system's temporary one, and removes
//   them
//
// Shard writing: the part of the threads' time that passes between the end of one tile's computation and the
// beginning of the next in the same thread, waiting for the lock and for the disk included.
// Assembly: bytes of the variables as the file stores them, uncompressed, by the CPU time of all threads and
// by the wall (which waits until the file is on the disk).
#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>

#include "engine/run.hpp"
#include "results/storage.hpp"
#include "studies/map/assemble.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/study_path.hpp"

namespace {

using namespace frahm;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// The time of all threads, in their tiles and between them [s].
struct Times {
  std::mutex turn;
  double inside = 0.0, between = 0.0;
};

// A kernel that takes its times.
class TimedKernel {
 public:
  TimedKernel(engine::Kernel kernel, Times& times) : kernel_(std::move(kernel)), times_(times) {}
  ~TimedKernel() {
    const std::lock_guard turn(times_.turn);
    times_.inside += inside_;
    times_.between += between_;
  }
  TimedKernel(const TimedKernel&) = delete;
  TimedKernel& operator=(const TimedKernel&) = delete;

  void operator()(std::uint64_t tile, engine::Bytes& out) {
    const Clock::time_point begin = Clock::now();
    if (end_ != Clock::time_point()) between_ += std::chrono::duration<double>(begin - end_).count();
    kernel_(tile, out);
    end_ = Clock::now();
    inside_ += std::chrono::duration<double>(end_ - begin).count();
  }

 private:
  engine::Kernel kernel_;
  Times& times_;
  Clock::time_point end_;  // of the last tile
  double inside_ = 0.0, between_ = 0.0;
};

engine::Job timed(engine::Job job, Times& times) {
  job.make_kernel = [make = job.make_kernel, &times](const engine::StopAsked& stop) -> engine::Kernel {
    auto kernel = std::make_shared<TimedKernel>(make(stop), times);
    return [kernel](std::uint64_t tile, engine::Bytes& out) { (*kernel)(tile, out); };
  };
  return job;
}

// Of all variables at one point, as the file stores them.
double bytes_of_point(const studies::MapPlan& plan) {
  std::size_t bytes = 0;
  for (const auto& variable : studies::map_layout(plan, {}).variables)
    bytes += results::element_size(variable.type);
  return static_cast<double>(bytes);
}

void write_shards(const studies::MapPlan& plan, const std::filesystem::path& output, int threads) {
  Times times;
  const engine::Summary summary =
      engine::run(timed(studies::job_of(plan), times),
                  {.output = output, .threads = threads, .progress = engine::ProgressStyle::none});
  const double millions = 1e-6 * static_cast<double>(plan.grid.points());
  fmt::print(
      "  shard writing, {} threads: {:.2f} % of their time; {:.3f} thread seconds per million points, "
      "computing them {:.2f}; {:.1f} s wall in total\n",
      summary.threads, 100.0 * times.between / (times.between + times.inside), times.between / millions,
      times.inside / millions, summary.seconds);
}

// Assembles from links to the logs, which go with the assembly while the logs stay.
void assemble(const studies::MapPlan& plan, const std::filesystem::path& output, int threads) {
  const std::filesystem::path made = output.string() + ".made";
  std::vector<std::filesystem::path> links;
  for (const auto& log : engine::find_logs(output)) {
    links.push_back(engine::log_path(made, fmt::format("{}", links.size())));
    std::filesystem::create_hard_link(log, links.back());
  }
  const Clock::time_point start = Clock::now();
  const double cpu_start = cpu_seconds();
  studies::assemble(plan, {.command = "benchmark", .threads = threads, .started = studies::utc_now()},
                    {.output = made, .logs = links, .threads = threads, .stop_asked = [] { return false; }},
                    engine::OutputLock(made));
  const double cpu = cpu_seconds() - cpu_start, wall = seconds_since(start);
  const double megabytes = 1e-6 * bytes_of_point(plan) * static_cast<double>(plan.grid.points());
  const double millions = 1e-6 * static_cast<double>(plan.grid.points());
  fmt::print(
      "  assembly, {} threads: {:.0f} MB to {:.0f} MB in {:.2f} s CPU, {:.2f} s wall: {:.0f} MB/s per core "
      "by CPU, {:.0f} MB/s by the wall; "
      "{:.3f} s CPU per million points; peak memory so far {:.0f} MB\n",
      threads, megabytes, 1e-6 * static_cast<double>(std::filesystem::file_size(made)), cpu, wall,
      megabytes / cpu, megabytes / wall, cpu / millions, peak_megabytes());
  std::filesystem::remove(made);
}

void measure(const studies::Study& study, const std::filesystem::path& folder) {
  const studies::MapPlan plan = studies::plan_map(study, {});
  const std::filesystem::path output = folder / "map.h5";
  fmt::print("{}: {} points, {} variables, {:.0f} bytes per point in the file and {} in the log\n",
             study.source.name, plan.grid.points(), plan.variables.size(), bytes_of_point(plan),
             sizeof(double) * plan.variables.size());
  const int all = omp_get_num_procs();
  write_shards(plan, output, all);
  for (const int threads : std::set<int>{1, all}) assemble(plan, output, threads);
  engine::remove_logs(engine::find_logs(output));
}

// Den Hartog's map with so many points along the friction: 2886 points each.
studies::Study single_mass(int frictions) {
  std::ifstream file(study_path("den_hartog"));
  std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string points = "points = 25\n";
  const std::size_t at = text.find(points);
  if (at == std::string::npos) throw std::runtime_error("den_hartog.toml no longer has an axis of 25 points");
  text.replace(at, points.size(), fmt::format("points = {}\n", frictions));
  return studies::parse_study(text, "den_hartog.toml");
}

}  // namespace

int main(int argc, char** argv) {
  std::string folder = ((argc > 1 ? std::filesystem::path(argv[1]) : std::filesystem::temp_directory_path()) /
                        "frahm-writing-XXXXXX")
                           .string();
  if (::mkdtemp(folder.data()) == nullptr) throw std::runtime_error("cannot make the folder " + folder);
  studies::Study rig = studies::read_study(study_path("rig_atlas"));
  rig.sweep()->borders = false;  // what they cost is no writing
  measure(rig, folder);
  measure(single_mass(350), folder);
  measure(single_mass(3500), folder);
  std::filesystem::remove_all(folder);
}
