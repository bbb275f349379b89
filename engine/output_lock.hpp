#pragma once

#include <filesystem>

#include "engine/file.hpp"

namespace frahm::engine {

// Held by the one process that makes `output`: a run that is not one shard of several, from its first to its
// last access, or a merge. A shard of several holds the lock of its own log only.
// The lock is on the file <output>.frahm-lock, which names its holder and is removed with the lock; a file
// left by a killed process is harmless.
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

// The file of the lock: it exists while a process holds the lock, or after one was killed.
std::filesystem::path lock_path(const std::filesystem::path& output);

}  // namespace frahm::engine
