#include "engine/tile_index.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>

#include "engine/io_error.hpp"
#include "engine/log_format.hpp"
#include "engine/shard_log.hpp"
#include "engine/team.hpp"
#include "tests/engine/sample_job.hpp"

namespace tile_index_test {
using namespace frahm::engine;
using Catch::Matchers::Contains;

namespace {

const LogHeader study{.fingerprint = {.physics = "9a3f", .grid = "77c0"}, .tiles = 6};

void write_log(const Scratch& scratch, const std::string& writer, const std::vector<std::uint64_t>& tiles) {
  ShardLog log(log_path(scratch.output(), writer), study);
  for (const std::uint64_t tile : tiles) log.append(tile, sample(tile));
}

TileIndex index_all(const Scratch& scratch) {
  return index_tiles(find_logs(scratch.output()), study, [](auto&&...) {});
}

}  // namespace

TEST_CASE("finished tiles come in their order from all logs, each once") {
  const Scratch scratch;
  write_log(scratch, "a", {5, 0, 3});
  write_log(scratch, "b", {3, 1});
  const TileIndex index = index_all(scratch);
  CHECK(missing_tiles(index) == std::vector<std::uint64_t>{2, 4});

  std::vector<std::uint64_t> order;
  bool right = true;
  for_each_tile(index, [&](std::uint64_t tile, auto bytes) {
    order.push_back(tile);
    right = right && std::ranges::equal(bytes, sample(tile));
  });
  CHECK(order == std::vector<std::uint64_t>{0, 1, 3, 5});
  CHECK(right);
}

TEST_CASE("of a tile recorded twice the record of the first log counts") {
  const Scratch scratch;
  const Bytes first(3, std::byte{1});
  const Bytes second(5, std::byte{2});
  { ShardLog(log_path(scratch.output(), "a"), study).append(4, first); }
  { ShardLog(log_path(scratch.output(), "b"), study).append(4, second); }
  CHECK(kept_tiles(scratch.output(), study) == std::map<std::uint64_t, Bytes>{{4, first}});
}

TEST_CASE("the logs of an output are found by name, and no others") {
  const Scratch scratch;
  const auto in = [&](const char* name) { return scratch.directory() / name; };
  for (const char* name : {"map.h5.a.frahm-log", "map.h5.shard-1-of-2.frahm-log"}) write_file(in(name), "");
  for (const char* name : {"map.h5", "map.h5.frahm-log", "map.h5..frahm-log", "map.h5.old.a.frahm-log",
                           "map.h55.a.frahm-log", "other.h5.a.frahm-log", "map.h5.a.frahm-log.bak"}) {
    write_file(in(name), "");
  }
  CHECK(find_logs(scratch.output()) ==
        std::vector{in("map.h5.a.frahm-log"), in("map.h5.shard-1-of-2.frahm-log")});
}

TEST_CASE("the end of a log behind its last good record is reported and not used") {
  const Scratch scratch;
  write_log(scratch, "a", {0, 1});
  const auto path = log_path(scratch.output(), "a");
  const auto size = std::filesystem::file_size(path);
  write_file(path, read_file(path) + "torn");
  const TileIndex index = index_all(scratch);
  CHECK(missing_tiles(index).size() == 4);
  REQUIRE(index.unused.size() == 1);
  CHECK(index.unused[0].log == path);
  CHECK(index.unused[0].from == size);
  CHECK(index.unused[0].bytes == 4);
}

TEST_CASE("a log of another study is refused by the index, unless it keeps nothing") {
  const Scratch scratch;
  write_log(scratch, "a", {0});
  LogHeader other = study;
  other.fingerprint.grid = "0bad";
  CHECK_THROWS_AS(kept_tiles(scratch.output(), other), ResumeRefused);
  std::filesystem::resize_file(log_path(scratch.output(), "a"), header_size);
  CHECK(kept_tiles(scratch.output(), other).empty());
}

TEST_CASE("the same fingerprint with another number of tiles is refused as another grid") {
  const Scratch scratch;
  write_log(scratch, "a", {0});
  LogHeader other = study;
  other.tiles = 7;
  CHECK_THROWS_WITH(kept_tiles(scratch.output(), other), Contains("another grid") && Contains("7"));
}

TEST_CASE("a record damaged after it was indexed is an error naming file and tile") {
  const Scratch scratch;
  write_log(scratch, "a", {1});
  const TileIndex index = index_all(scratch);
  const auto path = log_path(scratch.output(), "a");
  std::string bytes = read_file(path);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  write_file(path, bytes);
  CHECK_THROWS_WITH(for_each_tile(index, [](auto&&...) {}), Contains(path.string()) && Contains("tile 1"));
}

TEST_CASE("tiles are read from more logs than a process may hold open") {
  const Scratch scratch;
  const LogHeader many{.fingerprint = study.fingerprint, .tiles = 600};
  for (std::uint64_t tile = 0; tile < many.tiles; ++tile) {
    ShardLog(log_path(scratch.output(), std::to_string(tile % 300)), many).append(tile, sample(tile));
  }
  CHECK(kept_tiles(scratch.output(), many) == expected_tiles(many.tiles));
}

TEST_CASE("several threads read tiles from more logs than are open at once, in any order") {
  const Scratch scratch;
  const LogHeader many{.fingerprint = study.fingerprint, .tiles = 900};
  for (std::uint64_t tile = 0; tile < many.tiles; ++tile) {
    ShardLog(log_path(scratch.output(), std::to_string(tile % 300)), many).append(tile, sample(tile));
  }
  const TileIndex index = index_tiles(find_logs(scratch.output()), many, [](auto&&...) {});
  TileReader reader(index);
  std::atomic<std::uint64_t> right = 0, next_stride = 0;
  const auto error = run_team(4, [&](const auto&) {
    Bytes entry;
    const std::uint64_t stride = 12 * next_stride++ + 7;  // 7, 19, ... share no factor with 900
    for (std::uint64_t i = 0; i < many.tiles; ++i) {
      const std::uint64_t tile = i * stride % many.tiles;
      if (std::ranges::equal(reader.read(tile, entry), sample(tile))) ++right;
    }
  });
  CHECK(error == nullptr);
  CHECK(right == 4 * many.tiles);
}

TEST_CASE("a log removed while its tiles are read is an error naming it") {
  const Scratch scratch;
  write_log(scratch, "a", {1});
  const TileIndex index = index_all(scratch);
  TileReader reader(index);
  std::filesystem::remove(log_path(scratch.output(), "a"));
  Bytes entry;
  CHECK_THROWS_WITH(reader.read(1, entry), Contains("map.h5.a.frahm-log") && Contains("was removed while"));
}

TEST_CASE("removed logs are gone, and a log that vanished is passed over") {
  const Scratch scratch;
  write_log(scratch, "a", {0});
  write_log(scratch, "b", {1});
  const auto logs = find_logs(scratch.output());
  remove_logs(logs);
  CHECK(find_logs(scratch.output()).empty());
  CHECK(missing_tiles(index_tiles(logs, study, [](auto&&...) {})).size() == study.tiles);
  CHECK_FALSE(study_of_log(logs[0]).has_value());
}

TEST_CASE("a directory that is not there is an error naming it") {
  const Scratch scratch;
  CHECK_THROWS_WITH(find_logs(scratch.directory() / "absent" / "map.h5"),
                    Contains("absent") && Contains("No such file"));
}
}  // namespace tile_index_test
