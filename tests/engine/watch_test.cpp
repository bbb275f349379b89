#include "engine/watch.hpp"

#include <atomic>
#include <catch2/catch.hpp>

namespace watch_test {
using namespace frahm::engine;
using namespace std::chrono_literals;

TEST_CASE("a watch looks again and again until it is ended") {
  std::atomic<int> looks = 0;
  Watch watch(1ms, [&] { ++looks; });
  while (looks < 3) std::this_thread::yield();
  watch.end();
  const int at_end = looks;
  std::this_thread::sleep_for(5ms);
  CHECK(looks == at_end);
}

TEST_CASE("a watch that is ended at once has looked") {
  for (int i = 0; i < 100; ++i) {
    std::atomic<int> looks = 0;
    {
      const Watch watch(1h, [&] { ++looks; });
    }
    REQUIRE(looks == 1);
  }
}

TEST_CASE("a watch with a long period ends at once") {
  const auto start = std::chrono::steady_clock::now();
  {
    Watch watch(1h, [] {});
  }
  CHECK(std::chrono::steady_clock::now() - start < 10s);
}
}  // namespace watch_test
