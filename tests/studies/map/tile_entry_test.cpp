#include "studies/map/tile_entry.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace tile_entry_test {
namespace {

using namespace frahm::studies;

const TileEntry sample{.values = {1.5, -0.0, std::numeric_limits<double>::quiet_NaN()},
                       .failed = {{2, "it did not converge"}, {0, ""}}};

TEST_CASE("a tile's record gives back its values and its failed points") {
  frahm::engine::Bytes bytes;
  encode(sample, bytes);
  TileEntry read;
  decode(bytes, sample.values.size(), read);
  CHECK(read.values[0] == 1.5);
  CHECK(std::signbit(read.values[1]));
  CHECK(std::isnan(read.values[2]));
  REQUIRE(read.failed.size() == 2);
  CHECK(read.failed[0].offset == 2);
  CHECK(read.failed[0].reason == "it did not converge");
  CHECK(count_failed(bytes, sample.values.size()) == 2);
}

TEST_CASE("a tile's record gives back its borders, also where there are none, and counts no failure more") {
  using frahm::periodic::Regime;
  const Border border{3, 2, 1, {0.625, Regime::one_stop, Regime::stuck}};
  for (const std::size_t borders : {0, 2}) {
    TileEntry entry = sample;
    entry.borders.emplace(borders, border);
    frahm::engine::Bytes bytes;
    encode(entry, bytes);
    CHECK(count_failed(bytes, sample.values.size()) == 2);
    TileEntry read;
    decode(bytes, sample.values.size(), read);
    CHECK(read.failed.size() == 2);
    REQUIRE(read.borders);
    REQUIRE(read.borders->size() == borders);
    for (const Border& back : *read.borders) {
      CHECK(back.offset == 3);
      CHECK(back.dimension == 2);
      CHECK(back.element == 1);
      CHECK(back.crossing.at == 0.625);
      CHECK(back.crossing.below == Regime::one_stop);
      CHECK(back.crossing.above == Regime::stuck);
    }
  }
  frahm::engine::Bytes bytes;
  encode(sample, bytes);
  TileEntry read;
  read.borders.emplace();
  decode(bytes, sample.values.size(), read);
  CHECK_FALSE(read.borders);
}

TEST_CASE("values are kept least significant byte first") {
  frahm::engine::Bytes bytes;
  encode({.values = {1.0}, .failed = {}}, bytes);
  CHECK(bytes[7] == std::byte{0x3f});
  CHECK(bytes[0] == std::byte{0});
}

TEST_CASE("a record cut short anywhere but between failed points is refused") {
  frahm::engine::Bytes bytes;
  encode(sample, bytes);
  TileEntry read;
  for (const std::size_t size : {std::size_t{5}, std::size_t{23}, std::size_t{30}, std::size_t{45}}) {
    CHECK_THROWS_AS(decode(std::span(bytes).first(size), sample.values.size(), read), std::runtime_error);
  }
}

}  // namespace
}  // namespace tile_entry_test
