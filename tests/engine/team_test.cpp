#include "engine/team.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

namespace team_test {
using namespace frahm::engine;

TEST_CASE("a team does its work once in each thread and ends without an error") {
  std::atomic<int> calls = 0;
  CHECK(run_team(4, [&](const auto&) { ++calls; }) == nullptr);
  CHECK(calls == 4);
}

TEST_CASE("the exception of one thread stops the others and comes back") {
  std::atomic<bool> first = true;
  const std::exception_ptr error = run_team(3, [&](const std::atomic<bool>& failed) {
    if (first.exchange(false)) throw std::domain_error("our own bug");
    while (!failed) std::this_thread::yield();
  });
  CHECK_THROWS_AS(std::rethrow_exception(error), std::domain_error);
}

TEST_CASE("a team works on after one that failed") {
  run_team(2, [](const auto&) { throw std::domain_error("our own bug"); });
  CHECK(run_team(2, [](const auto&) {}) == nullptr);
}

TEST_CASE("a team has no more threads than pieces of work, and one at least") {
  CHECK(team_size(4, 100) == 4);
  CHECK(team_size(4, 3) == 3);
  CHECK(team_size(4, 0) == 1);
  CHECK(team_size(0, 1) == 1);
  CHECK(team_size(0, 1000000) >= 1);
}

namespace {

// A variable of the environment while a test runs; null: unset.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) { value ? ::setenv(name_, value, 1) : ::unsetenv(name_); }

  const char* name_;
  std::optional<std::string> before_;
};

int threads_with_slurm(const char* processors) {
  const Variable slurm("SLURM_CPUS_PER_TASK", processors);
  return default_threads();
}

}  // namespace

TEST_CASE("a task of Slurm has a thread for each processor it was given, and no more than there are") {
  const Variable openmp("OMP_NUM_THREADS", nullptr);
  const int all = threads_with_slurm(nullptr);
  CHECK(all >= 1);
  CHECK(threads_with_slurm("1") == 1);
  CHECK(threads_with_slurm("1000000") == all);
  for (const char* wrong : {"", "0", "-1", "many"}) CHECK(threads_with_slurm(wrong) == all);
}
}  // namespace team_test
