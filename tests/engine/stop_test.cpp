#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "engine/run.hpp"
#include "engine/stop_signals.hpp"
#include "tests/engine/sample_job.hpp"

namespace stop_test {
using namespace frahm::engine;
using Catch::Matchers::Contains;

namespace {

constexpr const char* child_output = "FRAHM_TEST_OUTPUT";

// Runs one hidden test case of this program in a process of its own; returns how that ended, as of waitpid.
int run_in_child(std::string test) {
  std::string program = "/proc/self/exe";
  char* arguments[] = {program.data(), test.data(), nullptr};
  pid_t child = 0;
  REQUIRE(::posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments, environ) == 0);
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  return status;
}

}  // namespace

TEST_CASE("a signal stops the run after the tiles in hand, and the next run goes on from there") {
  const Scratch scratch;
  const int signal = GENERATE(SIGTERM, SIGINT, SIGUSR1);
  const int threads = GENERATE(1, 3);
  const Job stopping = sample_job(80, [signal](std::uint64_t tile) {
    if (tile == 30) ::kill(::getpid(), signal);
    if (tile > 30) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  const Summary stopped = run(stopping, quiet(scratch, threads));
  CHECK(stopped.outcome == Outcome::stopped);
  CHECK_THAT(stopped.reason, Contains(signal_name(signal)));
  CHECK(stopped.tiles_computed >= 31);
  CHECK(stopped.tiles_computed < 80);
  CHECK(stopped.points.done < stopped.points.points);

  const Summary resumed = run(sample_job(80), quiet(scratch, threads));
  CHECK(resumed.outcome == Outcome::complete);
  CHECK(resumed.tiles_resumed == stopped.tiles_computed);
  CHECK(kept_tiles(scratch.output(), study_of(stopping)) == expected_tiles(80));
}

TEST_CASE("a signal that is ignored when the run begins does not stop it, and is ignored afterwards") {
  const Scratch scratch;
  const int signal = GENERATE(SIGTERM, SIGINT, SIGUSR1);
  const auto before = std::signal(signal, SIG_IGN);
  const Summary summary = run(sample_job(20,
                                         [signal](std::uint64_t tile) {
                                           if (tile == 3) std::raise(signal);
                                         }),
                              quiet(scratch));
  CHECK(std::signal(signal, before) == SIG_IGN);
  CHECK(summary.outcome == Outcome::complete);
}

TEST_CASE("a run that is stopped again and again ends with the bytes of an uninterrupted one") {
  const Scratch scratch;
  RunOptions options = quiet(scratch);
  const Job job = sample_job(50, [](std::uint64_t tile) {
    if (tile % 6 == 5) std::raise(SIGTERM);
  });
  int runs = 1;
  while (run(job, options).outcome == Outcome::stopped) ++runs;
  CHECK(runs > 2);
  CHECK(kept_tiles(scratch.output(), study_of(job)) == expected_tiles(50));
}

TEST_CASE("a kernel that is asked to stop gives its tile up, and nothing is kept of it") {
  const Scratch scratch;
  Job patient = sample_job(8);
  patient.make_kernel = [](const StopAsked& stop_asked) -> Kernel {
    return [stop_asked](std::uint64_t tile, Bytes& out) {
      write_sample(tile, out);
      if (tile < 5) return;
      std::raise(SIGTERM);
      while (!stop_asked()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      throw GivenUp{};
    };
  };
  const Summary stopped = run(patient, quiet(scratch, 1));
  CHECK(stopped.outcome == Outcome::stopped);
  CHECK_THAT(stopped.reason, Contains("SIGTERM"));
  CHECK(stopped.tiles_computed == 5);
  CHECK(kept_tiles(scratch.output(), study_of(patient)) == expected_tiles(5));
}

TEST_CASE("the time budget stops the run") {
  const Scratch scratch;
  const Job slow = sample_job(1000, [](auto) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); });
  RunOptions options = quiet(scratch);
  options.time_budget = std::chrono::milliseconds(60);
  const Summary summary = run(slow, options);
  CHECK(summary.outcome == Outcome::stopped);
  CHECK_THAT(summary.reason, Contains("time budget of 0.06 s"));
  CHECK(summary.seconds >= 0.06);
  CHECK(summary.tiles_computed > 0);
  CHECK(kept_tiles(scratch.output(), study_of(slow)).size() == summary.tiles_computed);
}

TEST_CASE("what the program has used of the time budget before the run counts") {
  const Scratch scratch;
  RunOptions options = quiet(scratch);
  options.time_budget = std::chrono::hours(1);
  options.begun = std::chrono::steady_clock::now() - std::chrono::hours(2);
  const Summary summary = run(sample_job(10), options);
  CHECK(summary.outcome == Outcome::stopped);
  CHECK_THAT(summary.reason, Contains("time budget of 3600 s"));
  CHECK(summary.tiles_computed == 0);
}

TEST_CASE("a signal after the last tile was taken does not make a complete run a stopped one") {
  const Scratch scratch;
  const Job job = sample_job(5, [](std::uint64_t tile) {
    if (tile == 4) std::raise(SIGTERM);
  });
  CHECK(run(job, quiet(scratch, 1)).outcome == Outcome::complete);
}

TEST_CASE("the signal handlers found before a run are put back after it") {
  const Scratch scratch;
  const auto before = std::signal(SIGTERM, SIG_IGN);
  run(sample_job(3), quiet(scratch));
  CHECK(std::signal(SIGTERM, before) == SIG_IGN);
}

TEST_CASE("two runs at once in one process are refused") {
  const StopSignals running;
  const Scratch scratch;
  CHECK_THROWS_AS(run(sample_job(3), quiet(scratch)), std::logic_error);
}

TEST_CASE("(in a child) SIGINT twice", "[.]") {
  const StopSignals signals;
  std::raise(SIGINT);
  if (signals.received() == SIGINT) std::raise(SIGINT);
}

TEST_CASE("a second SIGINT ends the process at once") {
  const int status = run_in_child("(in a child) SIGINT twice");
  REQUIRE(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGINT);
}

TEST_CASE("(in a child) a run killed at tile 17", "[.]") {
  const Job job = sample_job(40, [](std::uint64_t tile) {
    if (tile == 17) std::raise(SIGKILL);
  });
  const std::filesystem::path output = std::getenv(child_output);
  run(job, {.output = output, .threads = 1, .fresh = false, .progress = ProgressStyle::none});
}

TEST_CASE("a kill loses only the tiles in hand") {
  const Scratch scratch;
  ::setenv(child_output, scratch.output().c_str(), 1);
  const int status = run_in_child("(in a child) a run killed at tile 17");
  ::unsetenv(child_output);
  REQUIRE(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGKILL);
  CHECK(run(sample_job(40), quiet(scratch)).tiles_resumed == 17);
  CHECK(kept_tiles(scratch.output(), study_of(sample_job(40))) == expected_tiles(40));
}
}  // namespace stop_test
