#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace frahm::fuzz {

// Bytes under a path, for readers that open files; gone with the object.
class FileInMemory {
 public:
  explicit FileInMemory(std::span<const std::uint8_t> bytes);
  ~FileInMemory();
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;

  std::filesystem::path path() const;

 private:
  int descriptor_;
};

}  // namespace frahm::fuzz
