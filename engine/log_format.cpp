#include "engine/log_format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "engine/checksum.hpp"
#include "engine/io_error.hpp"

namespace frahm::engine {
namespace {

constexpr std::string_view file_magic = "FRAHMLOG";
constexpr std::uint32_t entry_magic = 0x454C4954U;  // "TILE" in the file
constexpr std::size_t hash_size = 64;
constexpr std::size_t version_at = 8, tiles_at = 12, physics_at = 20, grid_at = 84, header_crc_at = 148;
static_assert(header_crc_at + sizeof(std::uint32_t) == owner_offset);
// From owner_offset on:
constexpr std::size_t writer_size = header_size - owner_offset;
constexpr std::size_t began_at = owner_size, found_at = 92, writer_crc_at = 100;
static_assert(began_at + sizeof(std::uint64_t) == found_at &&
              found_at + sizeof(std::uint64_t) == writer_crc_at &&
              writer_crc_at + sizeof(std::uint32_t) == writer_size);

void put_text(std::byte* to, std::string_view text) {
  std::memcpy(to, text.data(), text.size());
}

void put_hash(std::byte* to, const std::string& hash, std::string_view name) {
  if (hash.empty() || hash.size() > hash_size) {
    throw std::invalid_argument(fmt::format("{} fingerprint '{}' has {} characters: it must have 1 to {}",
                                            name, hash, hash.size(), hash_size));
  }
  put_text(to, hash);
}

std::string get_hash(const std::byte* from) {
  const auto* text = reinterpret_cast<const char*>(from);
  return std::string(text, strnlen(text, hash_size));
}

// The header is synced before the first entry is appended: until then a power failure may leave zeros of it.
bool is_unsynced_header(const File& file) {
  return file.size() <= header_size && file.holds_only_zeros();
}

}  // namespace

Bytes encode_header(const LogHeader& header) {
  Bytes bytes(header_size, std::byte{0});
  put_text(bytes.data(), file_magic);
  put_little_endian(&bytes[version_at], log_version);
  put_little_endian(&bytes[tiles_at], header.tiles);
  put_hash(&bytes[physics_at], header.fingerprint.physics, "physics");
  put_hash(&bytes[grid_at], header.fingerprint.grid, "grid");
  put_little_endian(&bytes[header_crc_at], crc32c(std::span(bytes).first(header_crc_at)));
  return bytes;
}

Bytes encode_writer(const WriterStart& start) {
  using std::chrono::milliseconds;
  const auto began = std::chrono::floor<milliseconds>(start.time.time_since_epoch()).count();
  Bytes bytes(writer_size, std::byte{0});
  put_text(bytes.data(), std::string_view(this_process()).substr(0, owner_size));
  put_little_endian(&bytes[began_at], static_cast<std::uint64_t>(began));
  put_little_endian(&bytes[found_at], start.good_bytes);
  put_little_endian(&bytes[writer_crc_at], crc32c(std::span(bytes).first(writer_crc_at)));
  return bytes;
}

std::optional<WriterStart> read_writer(const File& log) {
  Bytes bytes(writer_size);
  if (log.read_at(owner_offset, bytes) < writer_size) return std::nullopt;
  const auto crc = get_little_endian<std::uint32_t>(&bytes[writer_crc_at]);
  if (crc32c(std::span(bytes).first(writer_crc_at)) != crc) return std::nullopt;
  const auto began = static_cast<std::int64_t>(get_little_endian<std::uint64_t>(&bytes[began_at]));
  return WriterStart{.time = std::chrono::system_clock::time_point(std::chrono::milliseconds(began)),
                     .good_bytes = get_little_endian<std::uint64_t>(&bytes[found_at])};
}

std::uint64_t study_mark(const LogHeader& header) {
  const Bytes bytes = encode_header(header);
  return crc64(std::span(bytes).subspan(tiles_at, header_crc_at - tiles_at));
}

void encode_entry(std::uint64_t mark, std::uint64_t tile, std::span<const std::byte> payload, Bytes& entry) {
  entry.resize(payload.size() + entry_overhead);
  put_little_endian(&entry[0], entry_magic);
  put_little_endian(&entry[4], log_version);
  put_little_endian(&entry[8], mark);
  put_little_endian(&entry[16], tile);
  put_little_endian(&entry[24], std::uint64_t{payload.size()});
  std::ranges::copy(payload, entry.begin() + entry_head_size);
  const std::size_t crc_at = entry_head_size + payload.size();
  put_little_endian(&entry[crc_at], crc32c(std::span(entry).first(crc_at)));
}

bool begins_as_log(const File& file) {
  std::array<char, file_magic.size()> text{};
  const std::size_t size = file.read_at(0, std::as_writable_bytes(std::span(text)));
  return file_magic.starts_with(std::string_view(text.data(), size)) || is_unsynced_header(file);
}

std::optional<LogHeader> read_header(const File& log) {
  if (!begins_as_log(log)) {
    throw IoError(
        log.path(),
        "not a shard log, or its header is damaged (it does not begin with FRAHMLOG); rename it, or "
        "remove it to have its tiles computed again");
  }
  Bytes bytes(header_size);
  if (log.read_at(0, bytes) < header_size || is_unsynced_header(log)) return std::nullopt;
  const auto version = get_little_endian<std::uint32_t>(&bytes[version_at]);
  if (version != log_version) {
    throw IoError(log.path(),
                  fmt::format("a shard log of version {}, or one with a damaged header; this program "
                              "reads version {}",
                              version, log_version));
  }
  const auto crc = get_little_endian<std::uint32_t>(&bytes[header_crc_at]);
  if (crc32c(std::span(bytes).first(header_crc_at)) != crc) {
    throw IoError(log.path(),
                  "the header of this shard log is damaged (its checksum is wrong); remove the file to "
                  "have its tiles computed again");
  }
  return LogHeader{.fingerprint = {get_hash(&bytes[physics_at]), get_hash(&bytes[grid_at])},
                   .tiles = get_little_endian<std::uint64_t>(&bytes[tiles_at])};
}

bool read_entry(const File& log, std::uint64_t offset, std::uint64_t file_size, std::uint64_t mark,
                std::uint64_t tiles, Bytes& entry) {
  if (offset > file_size || file_size - offset < entry_overhead) return false;
  entry.resize(entry_head_size);
  if (log.read_at(offset, entry) < entry_head_size) return false;
  const auto length = get_little_endian<std::uint64_t>(&entry[24]);
  const bool head_is_good = get_little_endian<std::uint32_t>(&entry[0]) == entry_magic &&
                            get_little_endian<std::uint32_t>(&entry[4]) == log_version &&
                            get_little_endian<std::uint64_t>(&entry[8]) == mark && tile_of(entry) < tiles &&
                            length <= file_size - offset - entry_overhead;
  if (!head_is_good) return false;

  entry.resize(static_cast<std::size_t>(length) + entry_overhead);
  const auto rest = std::span(entry).subspan(entry_head_size);
  if (log.read_at(offset + entry_head_size, rest) < rest.size()) return false;
  const std::size_t crc_at = entry.size() - sizeof(std::uint32_t);
  return crc32c(std::span(entry).first(crc_at)) == get_little_endian<std::uint32_t>(&entry[crc_at]);
}

std::uint64_t tile_of(const Bytes& entry) {
  return get_little_endian<std::uint64_t>(&entry[16]);
}

std::span<const std::byte> payload_of(const Bytes& entry) {
  return std::span(entry).subspan(entry_head_size, entry.size() - entry_overhead);
}

LogExtent read_entries(const File& log, const LogHeader& header, const EntryVisitor& visit) {
  const std::uint64_t mark = study_mark(header);
  LogExtent extent{.good_bytes = header_size, .file_bytes = log.size()};
  Bytes entry;
  while (read_entry(log, extent.good_bytes, extent.file_bytes, mark, header.tiles, entry)) {
    visit(tile_of(entry), extent.good_bytes, payload_of(entry));
    extent.good_bytes += entry.size();
    ++extent.entries;
  }
  return extent;
}

}  // namespace frahm::engine
