#include "engine/watch.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>

using namespace frahm::engine;
using namespace std::chrono_literals;

TEST_CASE("a watch looks again and again until it is ended") {
  std::atomic<int> looks = 0;
  Watch watch(1ms, [&] { ++looks; });
  while (looks < 3) std::this_thread::yield();
  CHECK(watch.end() == nullptr);
  const int at_end = looks;
  std::this_thread::sleep_for(5ms);
  CHECK(looks == at_end);
  CHECK_FALSE(watch.failed());
}

TEST_CASE("a watch that finds an error says so, stops looking and hands the error over") {
  std::atomic<int> looks = 0;
  Watch watch(1ms, [&] {
    if (++looks == 2) throw std::runtime_error("disk gone");
  });
  while (!watch.failed()) std::this_thread::yield();
  CHECK_THROWS_WITH(std::rethrow_exception(watch.end()), "disk gone");
  CHECK(looks == 2);
}

TEST_CASE("a watch with a long period ends at once") {
  const auto start = std::chrono::steady_clock::now();
  {
    Watch watch(1h, [] {});
  }
  CHECK(std::chrono::steady_clock::now() - start < 10s);
}
