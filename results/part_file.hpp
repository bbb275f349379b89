#pragma once

#include <filesystem>

namespace frahm::results {

// A file being written as <path>.part; publish() renames the complete file to <path> in one step.
class PartFile {
 public:
  explicit PartFile(std::filesystem::path path) : path_(std::move(path)), part_(path_.string() + ".part") {}
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  ~PartFile();  // removes the part, unless published

  const std::filesystem::path& part() const { return part_; }

  // Syncs the closed part to disk, renames it to its path and syncs the directory. Throws StoreError.
  void publish();

 private:
  std::filesystem::path path_, part_;
  bool published_ = false;  // if so, another process may be writing the next part
};

}  // namespace frahm::results
