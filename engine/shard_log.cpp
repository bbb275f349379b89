#include "engine/shard_log.hpp"

#include <algorithm>
#include <optional>
#include <system_error>

#include "engine/io_error.hpp"

namespace frahm::engine {

ShardLog::ShardLog(const std::filesystem::path& path, const LogHeader& header)
    : mark_(study_mark(header)), file_(open_locked(path, owner_offset)) {
  const std::optional<LogHeader> kept = read_header(file_);
  if (!kept) {
    begin(header);
    return;
  }
  found_ = read_entries(file_, *kept, [](auto&&...) {});
  if (*kept != header) {
    if (found_.entries > 0) throw ResumeRefused(path, *kept, header);
    begin(header);  // it holds no entry, so nothing is lost
    return;
  }
  file_.write_at(owner_offset, encode_writer({std::chrono::system_clock::now(), found_.good_bytes}));
  if (found_.unused_bytes() > 0) file_.truncate(found_.good_bytes);
  end_ = found_.good_bytes;
}

ShardLog::~ShardLog() {
  if (end_ > header_size) return;
  std::error_code ignored;  // an empty log that is left is harmless
  std::filesystem::remove(file_.path(), ignored);
}

void ShardLog::begin(const LogHeader& header) {
  found_ = {};
  file_.truncate(0);
  Bytes bytes = encode_header(header);
  std::ranges::copy(encode_writer({std::chrono::system_clock::now(), header_size}),
                    bytes.begin() + owner_offset);
  file_.write_at(0, bytes);
  file_.sync();
  sync_directory(directory_of(file_.path()));
  end_ = synced_end_ = header_size;
}

void ShardLog::append(std::uint64_t tile, std::span<const std::byte> payload) {
  Bytes entry;  // made before the turn, which is for the file alone
  encode_entry(mark_, tile, payload, entry);
  const std::lock_guard turn(append_turn_);
  try {
    file_.write_at(end_, entry);
  } catch (const IoError&) {
    // Cut off the part that was written. If that fails too, the reader stops there, and the next entry
    // overwrites it.
    try {
      file_.truncate(end_);
    } catch (const IoError&) {
    }
    throw;
  }
  end_ += entry.size();
}

void ShardLog::sync() {
  const std::lock_guard turn(sync_turn_);
  std::uint64_t end = 0;
  {
    const std::lock_guard append_turn(append_turn_);
    end = end_;
  }
  if (end == synced_end_) return;
  file_.sync();
  synced_end_ = end;
}

}  // namespace frahm::engine
