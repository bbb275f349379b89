#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "engine/bytes.hpp"
#include "engine/file.hpp"
#include "engine/fingerprint.hpp"

// The bytes of a shard log, all numbers little-endian:
//
//   header   0  "FRAHMLOG"                 entry   0  magic "TILE"
//            8  version             u32             4  version               u32
//           12  tiles of the study  u64             8  study: CRC-64 of the
//           20  physics, 64 bytes of text              header's bytes 12-147 u64
//           84  grid, 64 bytes of text             16  tile                  u64
//          148  CRC-32C of 0-147    u32            24  length of the payload u64
//          152  owner, 84 bytes of text            32  payload
//          236  began [ms since 1970]  u64       then  CRC-32C of all before u32
//          244  bytes found then       u64
//          252  CRC-32C of 152-251     u32
//          256  first entry
//
// Bytes 152 to 255 describe the last writer that held the lock: its name, when it began by its clock, and how
// many good bytes it found. They serve messages and the writer's rate. They change when a run resumes, so the
// study's CRC excludes them; if they are damaged, or of an older program, nothing else is lost. Every entry
// holds the CRC of its study, so that pieces of two logs can never pass for one.
namespace frahm::engine {

constexpr std::uint32_t log_version = 1;
constexpr std::size_t header_size = 256;
constexpr std::uint64_t owner_offset = 152;
constexpr std::size_t entry_head_size = 32;
constexpr std::size_t entry_overhead = entry_head_size + sizeof(std::uint32_t);

// The header of a log with zeros in the part of its writer.
// Throws std::invalid_argument for a hash of the fingerprint that is empty or longer than 64 characters.
Bytes encode_header(const LogHeader& header);

// The start of the present or last writer of a log.
struct WriterStart {
  std::chrono::system_clock::time_point time;  // to the millisecond
  std::uint64_t good_bytes = header_size;      // what the log held then
};

// The part of a header from owner_offset on, with this process as the owner.
Bytes encode_writer(const WriterStart& start);

// Nothing if the header of the log is cut off or damaged there, or of an older program.
std::optional<WriterStart> read_writer(const File& log);

// The CRC-64 that identifies the entries of a study.
std::uint64_t study_mark(const LogHeader& header);

// Makes `entry` the entry of one tile.
void encode_entry(std::uint64_t mark, std::uint64_t tile, std::span<const std::byte> payload, Bytes& entry);

// The header of a log; nothing if the file is shorter than a header (its writer was killed at its start).
// Throws IoError for a file that is no shard log, is one of another version, or has a damaged header.
std::optional<LogHeader> read_header(const File& log);

// Whether a file begins as a log does, though it may be cut off in its first bytes.
bool begins_as_log(const File& file);

// Reads the entry at `offset` into `entry` (the whole of it, checked); false if no good entry is there.
// file_size: bytes of the log that may be read.  tiles: their number in the study.
bool read_entry(const File& log, std::uint64_t offset, std::uint64_t file_size, std::uint64_t mark,
                std::uint64_t tiles, Bytes& entry);

// Parts of an entry that has been read.
std::uint64_t tile_of(const Bytes& entry);
std::span<const std::byte> payload_of(const Bytes& entry);

// The extent of a log.
struct LogExtent {
  std::uint64_t entries = 0;
  std::uint64_t good_bytes = 0;  // header and entries up to the first bad one
  std::uint64_t file_bytes = 0;

  // After the last good entry: one cut off by a kill or still being written, or damage.
  std::uint64_t unused_bytes() const { return file_bytes - good_bytes; }
};

// Calls visit(tile, offset of the entry, payload) for each entry in turn, up to the first bad one.
// header: that of the log.  Throws IoError when the log cannot be read, and what `visit` throws.
using EntryVisitor =
    std::function<void(std::uint64_t tile, std::uint64_t offset, std::span<const std::byte> payload)>;
LogExtent read_entries(const File& log, const LogHeader& header, const EntryVisitor& visit);

}  // namespace frahm::engine
