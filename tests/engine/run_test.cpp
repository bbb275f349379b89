#include "engine/run.hpp"

#include <sys/resource.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>
#include <mutex>
#include <set>

#include "engine/io_error.hpp"
#include "engine/shard_log.hpp"
#include "tests/engine/sample_job.hpp"

namespace run_test {
using namespace frahm::engine;
using Catch::Matchers::Contains;

namespace {

// The largest file this process may write, for as long as it lives: writes beyond it end short and then fail.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_before_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_before_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_before_)(int);
  rlimit before_{};
};

// Root may write everywhere, so for as long as it lives the process is nobody.
class Unprivileged {
 public:
  Unprivileged() : before_(::geteuid()) {
    if (before_ == 0 && ::seteuid(65534) != 0) throw std::runtime_error("cannot become nobody");
  }
  ~Unprivileged() {
    if (::seteuid(before_) != 0) std::abort();
  }
  Unprivileged(const Unprivileged&) = delete;
  Unprivileged& operator=(const Unprivileged&) = delete;

 private:
  uid_t before_;
};

std::uint64_t points_of(std::uint64_t tiles) {
  std::uint64_t points = 0;
  for (std::uint64_t tile = 0; tile < tiles; ++tile) points += sample_points(tile);
  return points;
}

}  // namespace

TEST_CASE("any number of threads leaves the same bytes in tile order") {
  const Job job = sample_job(200);
  const int threads = GENERATE(1, 2, 5);
  const Scratch scratch;
  const Summary summary = run(job, quiet(scratch, threads));
  CHECK(summary.outcome == Outcome::complete);
  CHECK(summary.threads == threads);
  CHECK(summary.tiles == 200);
  CHECK(summary.tiles_computed == 200);
  CHECK(summary.tiles_resumed == 0);
  CHECK(summary.points.points == points_of(200));
  CHECK(summary.points.done == summary.points.points);
  CHECK(summary.points.failed == 40);
  CHECK(kept_tiles(scratch.output(), study_of(job)) == expected_tiles(200));
}

TEST_CASE("each thread makes one kernel of its own") {
  const Scratch scratch;
  Job job = sample_job(50);
  std::atomic<int> made = 0;
  job.make_kernel = [&made, make = job.make_kernel](const StopAsked& stop_asked) {
    ++made;
    return make(stop_asked);
  };
  run(job, quiet(scratch, 3));
  CHECK(made == 3);
}

TEST_CASE("threads = 0 takes every processor, and never more threads than tiles") {
  const Scratch scratch;
  CHECK(run(sample_job(500), quiet(scratch, 0)).threads >= 1);
  const Scratch another;
  CHECK(run(sample_job(2), quiet(another, 8)).threads == 2);
}

TEST_CASE("a job of no tiles, or with nothing left to do, is complete") {
  const Scratch scratch;
  CHECK(run(sample_job(0), quiet(scratch)).outcome == Outcome::complete);
  CHECK(std::filesystem::is_empty(scratch.directory()));
  run(sample_job(9), quiet(scratch));
  const Summary again = run(sample_job(9), quiet(scratch));
  CHECK(again.outcome == Outcome::complete);
  CHECK(again.tiles_computed == 0);
  CHECK(again.tiles_resumed == 9);
  CHECK(again.points.resumed == points_of(9));
  CHECK(again.points.failed == sample_failures(3));
  CHECK_THAT(again.reason, Contains("every tile"));
}

TEST_CASE("shards together make the whole, in any order and cut") {
  const Scratch scratch;
  const Job job = sample_job(101);
  RunOptions options = quiet(scratch);
  for (const std::uint64_t index : {2, 0, 1}) {
    options.shard = {.index = index, .count = 3};
    CHECK(run(job, options).tiles == (index < 2 ? 34 : 33));
  }
  CHECK(find_logs(scratch.output()).size() == 3);
  CHECK(kept_tiles(scratch.output(), study_of(job)) == expected_tiles(101));

  options.shard = {};
  CHECK(run(job, options).tiles_resumed == 101);
}

TEST_CASE("a run takes up the tiles of all writers and computes the others only") {
  const Scratch scratch;
  std::mutex turn;
  std::multiset<std::uint64_t> computed;
  const Job job = sample_job(40, [&](std::uint64_t tile) {
    const std::lock_guard lock(turn);
    computed.insert(tile);
  });
  { ShardLog(log_path(scratch.output(), "elsewhere"), study_of(job)).append(7, sample(7)); }
  RunOptions options = quiet(scratch);
  options.shard = {.index = 1, .count = 4};
  run(job, options);
  options.shard = {};
  CHECK(run(job, options).tiles_resumed == 11);
  CHECK(std::set<std::uint64_t>(computed.begin(), computed.end()).size() == computed.size());
  CHECK(computed.size() == 39);
  CHECK(kept_tiles(scratch.output(), study_of(job)) == expected_tiles(40));
}

TEST_CASE("points that kernels found in an earlier result are in the summary") {
  const Scratch scratch;
  std::atomic<std::uint64_t> found = 0;
  Job job = sample_job(20, [&](std::uint64_t) { found += 3; });
  job.reused = [&] { return found.load(); };
  const Summary summary = run(job, quiet(scratch));
  CHECK(summary.points.reused == 60);
  CHECK(summary.points.done == points_of(20));
}

TEST_CASE("an exception of a kernel is thrown on when the finished tiles are kept") {
  const Scratch scratch;
  const int threads = GENERATE(1, 4);
  const Job broken = sample_job(60, [](std::uint64_t tile) {
    if (tile == 20) throw std::domain_error("our own bug");
  });
  CHECK_THROWS_AS(run(broken, quiet(scratch, threads)), std::domain_error);
  const auto kept = kept_tiles(scratch.output(), study_of(broken));
  CHECK(kept.size() >= 20);  // tiles are taken in order, and those in hand are finished
  CHECK_FALSE(kept.contains(20));
  const Summary summary = run(sample_job(60), quiet(scratch, threads));
  CHECK(summary.tiles_resumed == kept.size());
  CHECK(kept_tiles(scratch.output(), study_of(broken)) == expected_tiles(60));
}

TEST_CASE("an exception while a kernel is made is thrown on") {
  const Scratch scratch;
  Job job = sample_job(5);
  job.make_kernel = [](const StopAsked&) -> Kernel { throw std::domain_error("no kernel"); };
  CHECK_THROWS_AS(run(job, quiet(scratch)), std::domain_error);
}

TEST_CASE("a disk that fills up is an error, and every tile kept before is resumed") {
  const Scratch scratch;
  const Job job = sample_job(100);
  std::size_t kept = 0;
  {
    const FileSizeLimit limit(20'000);
    CHECK_THROWS_WITH(run(job, quiet(scratch, 1)), Contains("write") && Contains("frahm-log"));
    // The record that did not fit has been cut off.
    const TileIndex index = index_tiles(find_logs(scratch.output()), study_of(job), [](auto&&...) {});
    CHECK(index.unused.empty());
    kept = job.tiles - missing_tiles(index).size();
    CHECK(kept > 20);
  }
  CHECK(run(job, quiet(scratch)).tiles_resumed == kept);
  CHECK(kept_tiles(scratch.output(), study_of(job)) == expected_tiles(100));
}

TEST_CASE("the damaged end of a log is said in the summary and computed again") {
  const Scratch scratch;
  run(sample_job(10), quiet(scratch, 1));
  const auto path = find_logs(scratch.output()).front();
  const std::uint64_t size = std::filesystem::file_size(path);
  std::string bytes = read_file(path);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  write_file(path, bytes);
  const Summary summary = run(sample_job(10), quiet(scratch));
  CHECK(summary.tiles_resumed == 9);
  REQUIRE(summary.unused.size() == 1);
  CHECK(summary.unused[0].log == path);
  CHECK(summary.unused[0].from + summary.unused[0].bytes == size);
  CHECK(kept_tiles(scratch.output(), study_of(sample_job(10))) == expected_tiles(10));
}

TEST_CASE("a directory that may not be written is an error naming the file") {
  const Scratch scratch;
  std::filesystem::permissions(scratch.directory(), std::filesystem::perms(0555));
  const Unprivileged nobody;
  CHECK_THROWS_WITH(run(sample_job(5), quiet(scratch)),
                    Contains((scratch.directory() / "map.h5").string()) && Contains("Permission denied"));
}

TEST_CASE("a study that changed is refused and, asked to start afresh, discards the old tiles") {
  const Scratch scratch;
  run(sample_job(10), quiet(scratch));
  Job changed = sample_job(12);
  changed.fingerprint.physics = "0bad";
  CHECK_THROWS_AS(run(changed, quiet(scratch)), ResumeRefused);
  CHECK(kept_tiles(scratch.output(), study_of(sample_job(10))) == expected_tiles(10));

  RunOptions options = quiet(scratch);
  options.fresh = true;
  CHECK(run(changed, options).tiles_resumed == 0);
  CHECK(kept_tiles(scratch.output(), study_of(changed)) == expected_tiles(12));
}

TEST_CASE("a refused run leaves no log of its own behind") {
  const Scratch scratch;
  RunOptions options = quiet(scratch);
  options.shard = {.index = 0, .count = 2};
  run(sample_job(10), options);
  Job changed = sample_job(10);
  changed.fingerprint.grid = "0bad";
  CHECK_THROWS_AS(run(changed, quiet(scratch)), ResumeRefused);
  CHECK(find_logs(scratch.output()).size() == 1);
}

TEST_CASE("a fresh shard discards its own log and other studies, not the other shards of its study") {
  const Scratch scratch;
  Job old = sample_job(10);
  old.fingerprint.physics = "01d";
  RunOptions options = quiet(scratch);
  options.shard = {.index = 0, .count = 5};
  run(old, options);
  options.fresh = true;
  options.shard = {.index = 0, .count = 2};
  run(sample_job(10), options);
  options.shard = {.index = 1, .count = 2};
  run(sample_job(10), options);
  CHECK(find_logs(scratch.output()).size() == 2);
  CHECK(kept_tiles(scratch.output(), study_of(sample_job(10))) == expected_tiles(10));
  CHECK(run(sample_job(10), options).tiles_resumed == 0);
}

TEST_CASE("a second run of the same shard is refused while the first goes on") {
  const Scratch scratch;
  const Job job = sample_job(10);
  const ShardLog running(log_path(scratch.output(), "shard-0-of-1"), study_of(job));
  RunOptions options = quiet(scratch);
  CHECK_THROWS_AS(run(job, options), Locked);
  options.fresh = true;
  CHECK_THROWS_AS(run(job, options), Locked);
}

TEST_CASE("options outside their range are refused with their value") {
  const Scratch scratch;
  RunOptions options = quiet(scratch);
  options.shard = {.index = 4, .count = 4};
  CHECK_THROWS_WITH(run(sample_job(5), options), Contains("shard 4/4"));
  options.shard = {.index = 0, .count = 0};
  CHECK_THROWS_WITH(run(sample_job(5), options), Contains("shard 0/0"));
  CHECK_THROWS_WITH(run(sample_job(5), quiet(scratch, -3)), Contains("-3"));
  options = quiet(scratch);
  options.time_budget = std::chrono::seconds(-1);
  CHECK_THROWS_WITH(run(sample_job(5), options), Contains("-1"));
}
}  // namespace run_test
