#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/bytes.hpp"
#include "engine/file.hpp"
#include "engine/fingerprint.hpp"

// Reads the finished tiles of all writers of shards.
namespace frahm::engine {

// The log of a writer, next to the output: <output>.<writer>.frahm-log; a writer's name has no dot.
std::filesystem::path log_path(const std::filesystem::path& output, const std::string& writer);

// All logs next to `output`, by name. Throws IoError.
std::vector<std::filesystem::path> find_logs(const std::filesystem::path& output);

// The study a log belongs to, without reading its tiles; nothing if the log is gone or was cut off in its
// header. Throws IoError for a file that is no shard log, is one of another version, or has a damaged header.
std::optional<LogHeader> study_of_log(const std::filesystem::path& log);

// Bytes of a log after its last good entry, which are not used: an entry cut off by a kill or still being
// written, or damage.
struct UnusedBytes {
  std::filesystem::path log;
  std::uint64_t from = 0;  // offset in the file
  std::uint64_t bytes = 0;
};

// Where the finished tiles of a study lie. 16 bytes a tile, whatever the size of their entries.
struct TileIndex {
  static constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();
  struct Place {
    std::uint32_t log = nowhere;  // in `logs`; `nowhere`: not finished
    std::uint64_t offset = 0;     // of the entry
  };

  LogHeader study;
  std::vector<std::filesystem::path> logs;
  std::vector<Place> places;  // of each tile
  std::vector<UnusedBytes> unused;

  bool has(std::uint64_t tile) const { return places[tile].log != nowhere; }
};

// Called with a tile and the bytes its kernel wrote, which are valid only during the call.
using TileVisitor = std::function<void(std::uint64_t tile, std::span<const std::byte> bytes)>;

// Reads `logs` once, checking every entry; of a tile recorded twice the first one counts.
// Logs removed since they were listed, empty or assembled, are skipped. visit: called for each finished tile,
// in the order of the logs. Throws ResumeRefused for a log with tiles of another study, IoError, also where
// `visit` throws BadEntry.
TileIndex index_tiles(const std::vector<std::filesystem::path>& logs, const LogHeader& study,
                      const TileVisitor& visit);

// The tiles that are in no log, in order.
std::vector<std::uint64_t> missing_tiles(const TileIndex& index);

// Reads finished tiles in any order. Logs are opened when first needed: an array job may have left more of
// them than a process may hold open.
class TileReader {
 public:
  explicit TileReader(const TileIndex& index);  // which must outlive it

  // The bytes the kernel of a finished tile wrote. entry: holds them until it is changed. May be called from
  // several threads at once, each with an entry of its own.
  // Throws IoError when the entry can no longer be read as it was indexed.
  std::span<const std::byte> read(std::uint64_t tile, Bytes& entry);

 private:
  // Shared: a log may be closed here while it is read there.
  std::shared_ptr<const File> open(std::uint32_t log);

  const TileIndex& index_;
  std::uint64_t mark_;                              // of the study, in each entry
  int most_open_;                                   // logs open at a time
  std::mutex turn_;                                 // guards files_, open_
  std::vector<std::shared_ptr<const File>> files_;  // of TileIndex::logs; null: closed
  int open_ = 0;
};

// Calls visit for every finished tile in the order of their numbers, holding one entry in memory at a time.
// Throws IoError when an entry can no longer be read as it was indexed, and what `visit` throws.
void for_each_tile(const TileIndex& index, const TileVisitor& visit);

// Removes logs that no process is writing. Throws Locked at the first that is in use, IoError.
void remove_logs(const std::vector<std::filesystem::path>& logs);

// The same, but leaves logs in use; returns the message for each (Locked::what()).
std::vector<std::string> remove_free_logs(const std::vector<std::filesystem::path>& logs);

}  // namespace frahm::engine
