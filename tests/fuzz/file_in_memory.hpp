#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace frahm::fuzz {

// Bytes under a path, for readers that open files; gone with the object. It lies in memory (/dev/shm) where
// there is such a place; HDF5 asks for the real path, which a file without a name has not.
class FileInMemory {
 public:
  explicit FileInMemory(std::span<const std::uint8_t> bytes);
  ~FileInMemory();
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace frahm::fuzz
