#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>

#include "engine/file.hpp"
#include "engine/fingerprint.hpp"
#include "engine/log_format.hpp"

namespace frahm::engine {

// A writer's own shard log, open and locked: finished tiles are appended to it and survive a kill of the
// process from then on, and a power failure from the next sync() on.
//
// append() and sync() may be called from several threads at once.
class ShardLog {
 public:
  // Opens or creates the log of a study. Bytes after its last good entry are cut off.
  // Throws Locked if another process has it, ResumeRefused if it holds tiles of another study, IoError.
  ShardLog(const std::filesystem::path& path, const LogHeader& header);
  // A log without an entry is removed.
  ~ShardLog();
  ShardLog(const ShardLog&) = delete;
  ShardLog& operator=(const ShardLog&) = delete;

  // The extent of the log when it was opened; bytes after the good ones have been cut off.
  const LogExtent& found() const { return found_; }

  // Saves one finished tile. Throws IoError (disk full, ...), after which the tiles saved before are still
  // good and further ones may be appended.
  void append(std::uint64_t tile, std::span<const std::byte> payload);

  // Returns when all that was appended before the call is on the disk. Throws IoError.
  void sync();

 private:
  void begin(const LogHeader& header);

  std::uint64_t mark_;  // of the study, in each entry
  File file_;
  LogExtent found_;
  std::mutex append_turn_;  // guards end_ and the file's end
  std::uint64_t end_ = 0;   // of the last good entry
  std::mutex sync_turn_;    // guards synced_end_
  std::uint64_t synced_end_ = 0;
};

}  // namespace frahm::engine
