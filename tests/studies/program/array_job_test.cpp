#include "studies/program/array_job.hpp"

#include <catch2/catch.hpp>
#include <sstream>

namespace array_job_test {
namespace {

using namespace frahm::studies;

ArrayJob job(std::uint64_t tiles, std::optional<double> core_seconds, std::uint64_t most_tasks) {
  return {.study = "map.toml",
          .set = {},
          .noun = "map",
          .tiles = tiles,
          .core_seconds = core_seconds,
          .most_tasks = most_tasks};
}

TEST_CASE("tasks are of some ten minutes, at least two, at most the tiles and what an array may have") {
  CHECK(tasks_of(job(336, 5.0, 1001)) == 2);
  CHECK(tasks_of(job(500'000, 6001.0, 1001)) == 11);
  CHECK(tasks_of(job(500'000, 1e9, 1001)) == 1001);
  CHECK(tasks_of(job(500'000, 1e9, 201)) == 201);
  CHECK(tasks_of(job(7, 1e9, 1001)) == 7);
  CHECK(tasks_of(job(20, std::nullopt, 1001)) == 20);
  CHECK(tasks_of(job(1, 1e9, 1001)) == 1);
  CHECK(tasks_of(job(100, 1e9, 0)) == 0);
}

TEST_CASE("the highest index of the array is one below the number of tasks") {
  std::ostringstream out;
  print_array_job(job(500'000, 1e9, 1001), out);
  CHECK_THAT(out.str(),
             Catch::Contains("sbatch --array=0-1000 ") && Catch::Contains("$SLURM_ARRAY_TASK_ID/1001 "));
  print_array_job(job(1, 1e9, 1001), out);
  CHECK_THAT(out.str(), Catch::Contains("is a single tile, which tasks cannot share"));
  print_array_job(job(50, 1e9, 1), out);
  CHECK_THAT(out.str(), Catch::Contains("cannot be shared by the 1 task of an array"));
}

TEST_CASE("MaxArraySize is read from Slurm's configuration") {
  CHECK(max_array_size_in(
            "LogTimeFormat = iso8601_ms\nMaxArraySize            = 4001\nMaxJobCount = 10000\n") == 4001);
  CHECK(max_array_size_in("MaxArraySize = 0\n") == 0);
  CHECK_FALSE(max_array_size_in("").has_value());
  CHECK_FALSE(max_array_size_in("MaxArraySize = ").has_value());
  CHECK(most_array_tasks() > 0);
}

}  // namespace
}  // namespace array_job_test
