#include "engine/handout.hpp"

#include <catch2/catch.hpp>

namespace handout_test {
using namespace frahm::engine;

TEST_CASE("a block is a quarter of the rank's share by threads of what is left") {
  CHECK(block_size(800, 1, 2) == 64);  // at most 64 a thread
  CHECK(block_size(400, 1, 2) == 50);
  CHECK(block_size(400, 4, 8) == 50);
  CHECK(block_size(400, 1, 8) == 12);
  CHECK(block_size(100000, 4, 4) == 256);
}

TEST_CASE("there is a tile for each that asks as long as one is left") {
  CHECK(block_size(1, 64, 64) == 1);
  CHECK(block_size(3, 1, 1000) == 1);
}
}  // namespace handout_test
