#pragma once

#include <filesystem>

#include "engine/file.hpp"

namespace frahm::engine {

// Held by the one process that makes `output`: a run that is not one shard of several, from its first look at
// what is there to its last, or a merge. A shard of several holds the lock of its own log only.
// The lock is that of the file <output>.frahm-lock, which tells its holder and goes with it; one that a
// killed process has left is harmless.
class OutputLock {
 public:
  // Throws Locked if another process makes the output, IoError.
  explicit OutputLock(const std::filesystem::path& output);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  File file_;
};

// The file of the lock, which is there while a process holds it, or when one was killed.
std::filesystem::path lock_path(const std::filesystem::path& output);

}  // namespace frahm::engine
