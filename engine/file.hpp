#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace frahm::engine {

// An open file. Every operation throws IoError with the path and the system's reason, and goes on after an
// interrupting signal.
class File {
 public:
  // For reading and writing; created empty if absent. A symbolic link there is not followed but refused.
  static File open_for_writing(const std::filesystem::path& path);
  // For reading; nothing if there is no such file.
  static std::optional<File> open_if_present(const std::filesystem::path& path);

  File(File&& other) noexcept;
  ~File();

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const;

  // Fills `to` from `offset` [bytes] on; the number of bytes read is smaller than to.size() only at the end
  // of the file.
  std::size_t read_at(std::uint64_t offset, std::span<std::byte> to) const;
  // Also of an empty file. After a power failure bytes that were not synced may be zeros.
  bool holds_only_zeros() const;
  // Writes all of `from` at `offset` [bytes]: in one call to the kernel, unless the kernel takes only a part.
  void write_at(std::uint64_t offset, std::span<const std::byte> from);
  void truncate(std::uint64_t size);
  // Returns when the data are on the disk (fdatasync).
  void sync();

  // Takes the exclusive lock of the file, which is held until the file is closed; false: it is taken.
  bool try_lock();
  // Whether the lock is taken at this moment. Holds no lock afterwards; a process waiting in open_locked()
  // still gets it.
  bool is_locked() const;
  // Whether path() still leads to this file: false when it was removed or replaced since it was opened.
  bool is_at_its_path() const;

 private:
  File(std::filesystem::path path, int descriptor);

  std::filesystem::path path_;
  int descriptor_;
};

// Opens `path` for writing (created if absent) and takes its lock; waits up to a second, as a process that
// removes a file holds its lock for a moment.
// owner_at: offset at which the holder writes `this_process()`, for the message.
// Throws Locked, IoError.
File open_locked(const std::filesystem::path& path, std::uint64_t owner_at);

constexpr std::size_t owner_size = 84;  // bytes reserved for the owner's text

// "process 4711 on node17", at most owner_size bytes.
std::string this_process();

// Makes the names of new files in `directory` last through a power failure. Throws IoError.
void sync_directory(const std::filesystem::path& directory);

// The directory `path` lies in: "." for a bare name.
std::filesystem::path directory_of(const std::filesystem::path& path);

}  // namespace frahm::engine
