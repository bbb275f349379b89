#include "engine/survey.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <memory>
#include <thread>

#include "engine/shard_log.hpp"
#include "tests/engine/sample_job.hpp"

namespace survey_test {
using namespace frahm::engine;
using std::chrono::system_clock;

namespace {

constexpr std::uint64_t tiles = 12;
const Job job = sample_job(tiles);

std::uint64_t points_of(const std::vector<std::uint64_t>& some) {
  std::uint64_t points = 0;
  for (const std::uint64_t tile : some) points += sample_points(tile);
  return points;
}

// A log of the job with these tiles, still held by its writer.
std::unique_ptr<ShardLog> writer(const Scratch& scratch, const std::string& name,
                                 const std::vector<std::uint64_t>& some) {
  auto log = std::make_unique<ShardLog>(log_path(scratch.output(), name), study_of(job));
  for (const std::uint64_t tile : some) log->append(tile, sample(tile));
  return log;
}

Survey survey_in(const Scratch& scratch, system_clock::duration later) {
  return survey(job, find_logs(scratch.output()), system_clock::now() + later);
}

}  // namespace

TEST_CASE("a log's name tells its shard, whichever rank wrote it") {
  const auto is = [](const char* name, std::uint64_t index, std::uint64_t count) {
    const auto shard = shard_of_log(name);
    return shard && shard->index == index && shard->count == count;
  };
  CHECK(is("map.h5.shard-3-of-16.frahm-log", 3, 16));
  CHECK(is("/a.b/map.h5.shard-0-of-1-rank-12.frahm-log", 0, 1));
  CHECK(is("shard-1-of-2.shard-0-of-7.frahm-log", 0, 7));
  for (const char* other :
       {"map.h5.a.frahm-log", "map.h5.shard-3-of-3.frahm-log", "map.h5.shard-0-of-1-rank-0.frahm-log",
        "map.h5.shard-0-of-99999999999999999999.frahm-log", "map.h5.shard-0-of-1.frahm-log.old"}) {
    INFO(other);
    CHECK_FALSE(shard_of_log(other).has_value());
  }
}

TEST_CASE("a survey counts what all logs keep, and who is at work") {
  const Scratch scratch;
  writer(scratch, "shard-0-of-3", {0, 3, 6});
  const auto held = writer(scratch, "shard-1-of-3-rank-2", {1, 3});  // tile 3 twice, which counts once
  const Survey found = survey_in(scratch, {});
  CHECK(found.missing == std::vector<std::uint64_t>{2, 4, 5, 7, 8, 9, 10, 11});
  CHECK(found.points.points == points_of({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  CHECK(found.points.done == points_of({0, 1, 3, 6}));
  CHECK(found.points.failed == sample_failures(3));
  REQUIRE(found.writers.size() == 2);
  CHECK_FALSE(found.writers[0].at_work);
  CHECK(found.writers[1].at_work);
  CHECK(found.writers[1].shard->index == 1);
}

TEST_CASE("the rates of the writers at work add up, each since it began") {
  const Scratch scratch;
  writer(scratch, "shard-0-of-3", {0, 3});
  const auto resumed = writer(scratch, "shard-0-of-3", {6});
  const auto other = writer(scratch, "shard-1-of-3", {1, 4});
  writer(scratch, "shard-2-of-3", {2});                 // gone
  constexpr double seconds = 1000.0, tolerance = 1e-3;  // the writers began some ms before now
  const Survey found = survey_in(scratch, std::chrono::seconds(1000));
  REQUIRE(found.rate.has_value());
  CHECK(*found.rate == Approx(static_cast<double>(points_of({6, 1, 4})) / seconds).epsilon(tolerance));
  REQUIRE(found.seconds_left.has_value());
  CHECK(*found.seconds_left ==
        Approx(static_cast<double>(found.points.points - found.points.done) / *found.rate));
}

TEST_CASE("a clock set back, an older log, nobody at work: the rate is unknown, never nonsense") {
  const Scratch scratch;
  auto log = writer(scratch, "shard-0-of-1", {0, 1});
  CHECK_FALSE(survey_in(scratch, -std::chrono::hours(1)).rate.has_value());
  CHECK_FALSE(survey_in(scratch, -std::chrono::hours(1)).seconds_left.has_value());
  const Survey young = survey_in(scratch, {});  // too young to tell
  CHECK(young.rate == 0.0);
  CHECK_FALSE(young.seconds_left.has_value());
  {
    File header = File::open_for_writing(log_path(scratch.output(), "shard-0-of-1"));
    header.write_at(owner_offset, Bytes(header_size - owner_offset));
  }
  CHECK_FALSE(survey_in(scratch, std::chrono::hours(1)).rate.has_value());
  log.reset();
  CHECK_FALSE(survey_in(scratch, std::chrono::hours(1)).rate.has_value());
}

TEST_CASE("a survey does not disturb a writer that starts at the same moment") {
  const Scratch scratch;
  writer(scratch, "shard-0-of-1", {0});
  std::atomic<bool> ended = false;
  std::atomic<std::size_t> looks = 0;
  std::thread looking([&] {
    for (; !ended; ++looks) survey_in(scratch, {});
  });
  while (looks == 0) std::this_thread::yield();
  for (int i = 0; i < 50; ++i) CHECK_NOTHROW(writer(scratch, "shard-0-of-1", {}));
  ended = true;
  looking.join();
}
}  // namespace survey_test
