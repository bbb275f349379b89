#include "engine/tile_queue.hpp"

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <thread>
#include <vector>

namespace tile_queue_test {
using namespace frahm::engine;

TEST_CASE("tiles leave their queue in order, and none is left when it is closed and empty") {
  TileQueue queue;
  queue.add(std::array<std::uint64_t, 2>{4, 2});
  queue.add(std::array<std::uint64_t, 1>{9});
  queue.close();
  CHECK(queue.take() == 4U);
  CHECK(queue.take() == 2U);
  CHECK_FALSE(queue.is_empty());
  CHECK(queue.take() == 9U);
  CHECK(queue.is_empty());
  CHECK_FALSE(queue.take());
}

TEST_CASE("threads wait at an open queue for what is added, and leave when it is dropped") {
  TileQueue queue;
  std::atomic<std::uint64_t> sum = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&] {
      while (const auto tile = queue.take()) sum += *tile;
    });
  }
  queue.add(std::array<std::uint64_t, 3>{1, 10, 100});
  while (sum < 111) std::this_thread::yield();
  queue.drop();
  for (std::thread& thread : threads) thread.join();
  CHECK(sum == 111);
  CHECK(queue.is_empty());
}
}  // namespace tile_queue_test
