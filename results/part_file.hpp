#pragma once

#include <filesystem>
#include <string_view>

#include "results/store_error.hpp"

namespace frahm::results {

// Another process removed the part of a file as one left by a killed process. It can where machines share a
// folder but no locks, as over sshfs: what was written is to be written again.
class PartTaken : public StoreError {
 public:
  using StoreError::StoreError;
};

// A file being written under a name of its own in the folder of its path; publish() renames the complete file
// to the path in one step.
//
// The part's name is <path>.part- and 16 hex digits: 8 random ones and their complement, which the name of
// no other file has by chance. It is created again and follows no link, and is locked (flock) while it is
// written. A part left by a process that was killed, which no process has locked, is removed by the next one
// of the same path. (Its inode proves nothing: file systems on a network number their files again.)
class PartFile {
 public:
  // Creates the part, with the access rights of the file that it is to replace, otherwise those of any new
  // file. Throws StoreError.
  explicit PartFile(std::filesystem::path path);
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  ~PartFile();  // removes the part, unless published

  const std::filesystem::path& part() const { return part_; }

  // Writes after what the part holds. Throws StoreError; PartTaken if the part is gone.
  void write(std::string_view text);
  // Syncs the part to disk, renames it to its path and syncs the directory. Nobody may have it open for
  // writing. Throws StoreError; PartTaken if the part is gone.
  void publish();

 private:
  bool create();
  [[noreturn]] void give_up(const char* what, int error) const;

  std::filesystem::path path_, part_;
  int descriptor_ = -1;     // holds the lock
  bool published_ = false;  // if so, another process may be writing the next part
};

// Removes the parts of a path that killed processes have left.
void remove_dead_parts(const std::filesystem::path& path);

}  // namespace frahm::results
