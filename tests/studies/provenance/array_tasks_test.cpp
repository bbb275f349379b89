#include "studies/provenance/array_tasks.hpp"

#include <catch2/catch.hpp>

namespace array_tasks_test {
namespace {

using namespace frahm::studies;

using Numbers = std::vector<std::uint64_t>;
using Logs = std::vector<std::filesystem::path>;

TEST_CASE("numbers of tasks are written as Slurm writes them") {
  CHECK(array_list(Numbers{}) == "");
  CHECK(array_list(Numbers{7}) == "7");
  CHECK(array_list(Numbers{0, 1}) == "0-1");
  CHECK(array_list(Numbers{0, 1, 2, 3, 7, 9, 10, 11, 12, 13, 14, 15}) == "0-3,7,9-15");
}

TEST_CASE("tasks with missing tiles are told for each number of shards that left logs") {
  const Logs logs{"map.h5.shard-0-of-5.frahm-log", "map.h5.shard-0-of-5-rank-1.frahm-log",
                  "map.h5.shard-2-of-3.frahm-log", "map.h5.shard-0-of-1.frahm-log", "map.h5.old.frahm-log"};
  const auto arrays = task_arrays(logs, Numbers{1, 2, 6, 12});
  REQUIRE(arrays.size() == 2);
  CHECK(arrays[0].tasks == 3);
  CHECK(arrays[0].missing == Numbers{0, 1, 2});
  CHECK(arrays[1].tasks == 5);
  CHECK(arrays[1].missing == Numbers{1, 2});
  CHECK(missing_tasks_text(logs, Numbers{1, 2, 6, 12}) ==
        "; of 3 array tasks these have tiles missing: --array=0-2, or of 5 array tasks these have tiles "
        "missing: "
        "--array=1-2");
  CHECK(missing_tasks_text(Logs{"map.h5.shard-0-of-1.frahm-log"}, Numbers{1}) == "");
}

}  // namespace
}  // namespace array_tasks_test
