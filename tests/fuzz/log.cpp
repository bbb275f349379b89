// Any bytes as a shard log. The first byte chooses: a log as it is, or a log with right checksums around the
// bytes, whose records then reach the reader of tiles.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <stdexcept>

#include "engine/io_error.hpp"
#include "engine/log_format.hpp"
#include "engine/tile_index.hpp"
#include "studies/map/tile_entry.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/outcome.hpp"

namespace {

using namespace frahm;
using fuzz::Outcome;

constexpr std::size_t values_of_tile = 6;
const engine::LogHeader study{.fingerprint = {"physics", "grid"}, .tiles = 8};

// A record of a tile, read, is written as it was.
void read_tile(std::span<const std::byte> payload) {
  studies::TileEntry entry;
  try {
    studies::decode(payload, values_of_tile, entry);
  } catch (const std::runtime_error&) {  // a record cut short
    return;
  }
  engine::Bytes again;
  studies::encode(entry, again);
  if (!std::ranges::equal(again, payload)) std::abort();
  if (studies::count_failed(payload, values_of_tile) != entry.failed.size()) std::abort();
}

Outcome read_log(std::span<const std::uint8_t> bytes) {
  const fuzz::FileInMemory file(bytes);
  try {
    if (const auto log = engine::File::open_if_present(file.path())) engine::read_writer(*log);
    engine::study_of_log(file.path());
    const engine::TileIndex index =
        engine::index_tiles({file.path()}, study, [](std::uint64_t tile, std::span<const std::byte> payload) {
          if (tile >= study.tiles) std::abort();
          read_tile(payload);
        });
    engine::for_each_tile(index, [](std::uint64_t, std::span<const std::byte>) {});
    return Outcome::read;
  } catch (const engine::IoError&) {
    return Outcome::refused;
  } catch (const engine::ResumeRefused&) {
    return Outcome::refused;
  }
}

// A log of records: a byte names the tile, a byte the length of the payload that follows.
Outcome read_records(std::span<const std::uint8_t> bytes) {
  engine::Bytes log = engine::encode_header(study), entry;
  while (bytes.size() >= 2) {
    const std::uint64_t tile = bytes[0];
    const auto payload = bytes.subspan(2, std::min<std::size_t>(bytes[1], bytes.size() - 2));
    engine::encode_entry(engine::study_mark(study), tile, std::as_bytes(payload), entry);
    log.insert(log.end(), entry.begin(), entry.end());
    bytes = bytes.subspan(2 + payload.size());
  }
  return read_log({reinterpret_cast<const std::uint8_t*>(log.data()), log.size()});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span rest(data + 1, size - 1);
  fuzz::count(data[0] % 2 == 0 ? read_log(rest) : read_records(rest));
  return 0;
}
