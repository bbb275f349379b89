#include "engine/team.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <thread>

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
