#include "engine/stop_request.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <csignal>

namespace stop_request_test {
using namespace frahm::engine;
using namespace std::chrono_literals;

TEST_CASE("without a budget only a signal asks to stop, and is the reason") {
  const StopRequest stop(std::nullopt);
  CHECK_FALSE(stop.asked());
  CHECK(stop.reason().empty());
  std::raise(SIGTERM);
  CHECK(stop.asked());
  CHECK(stop.reason() == "stopped by SIGTERM");
}

TEST_CASE("a time budget asks to stop when it is used up, and not before") {
  const StopRequest long_one(1h);
  CHECK_FALSE(long_one.asked());
  CHECK(long_one.reason().empty());
}

TEST_CASE("a part of the budget may be used before") {
  const StopRequest stop(60s, 61s);
  CHECK(stop.asked());
  CHECK(stop.elapsed() >= 61s);
  CHECK(stop.reason() == "the time budget of 60 s is used up");
}

TEST_CASE("who started the work may call it off") {
  std::atomic<bool> called_off = false;
  const StopRequest stop(std::nullopt, 0s, &called_off);
  CHECK_FALSE(stop.asked());
  called_off = true;
  CHECK(stop.asked());
  CHECK(stop.reason() == "called off");
}
}  // namespace stop_request_test
