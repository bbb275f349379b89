#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <string>

#include "engine/run.hpp"

// A job without physics and a place on disk, for the tests of the engine.
namespace frahm::engine {

// A directory of its own for each test, removed at the end.
class Scratch {
 public:
  Scratch() {
    std::string pattern = (std::filesystem::temp_directory_path() / "frahm-engine-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no scratch directory: " + pattern);
    directory_ = pattern;
  }
  ~Scratch() { std::filesystem::remove_all(directory_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  const std::filesystem::path& directory() const { return directory_; }
  std::filesystem::path output() const { return directory_ / "map.h5"; }

 private:
  std::filesystem::path directory_;
};

// The record of a tile: 0 to 999 bytes that look random and depend on the tile alone.
inline void write_sample(std::uint64_t tile, Bytes& out) {
  std::uint64_t state = tile;
  const auto next = [&state] {  // splitmix64
    std::uint64_t z = (state += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  };
  out.resize(next() % 1000);
  for (std::byte& byte : out) byte = static_cast<std::byte>(next());
}

inline Bytes sample(std::uint64_t tile) {
  Bytes bytes;
  write_sample(tile, bytes);
  return bytes;
}

inline std::uint64_t sample_points(std::uint64_t tile) {
  return 100 + tile % 7;
}
inline std::uint64_t sample_failures(std::uint64_t tile) {
  return tile % 10 == 3 ? 2 : 0;
}

// A job whose kernels do `before` and then write the sample.
inline Job sample_job(
    std::uint64_t tiles, std::function<void(std::uint64_t tile)> before = [](std::uint64_t) {}) {
  return {.tiles = tiles,
          .fingerprint = {.physics = "9a3f", .grid = "77c0"},
          .make_kernel =
              [before](const StopAsked&) {
                return [before](std::uint64_t tile, Bytes& out) {
                  before(tile);
                  write_sample(tile, out);
                };
              },
          .points = sample_points,
          .failed = [](std::uint64_t tile, auto) { return sample_failures(tile); }};
}

inline LogHeader study_of(const Job& job) {
  return {.fingerprint = job.fingerprint, .tiles = job.tiles};
}

inline RunOptions quiet(const Scratch& scratch, int threads = 2) {
  return {.output = scratch.output(), .threads = threads, .fresh = false, .progress = ProgressStyle::none};
}

// All finished tiles beside the output, read back in order.
inline std::map<std::uint64_t, Bytes> kept_tiles(const std::filesystem::path& output,
                                                 const LogHeader& study) {
  std::map<std::uint64_t, Bytes> tiles;
  const TileIndex index = index_tiles(find_logs(output), study, [](auto&&...) {});
  for_each_tile(index,
                [&](std::uint64_t tile, auto bytes) { tiles[tile].assign(bytes.begin(), bytes.end()); });
  return tiles;
}

inline std::map<std::uint64_t, Bytes> expected_tiles(std::uint64_t tiles) {
  std::map<std::uint64_t, Bytes> expected;
  for (std::uint64_t tile = 0; tile < tiles; ++tile) expected[tile] = sample(tile);
  return expected;
}

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace frahm::engine
