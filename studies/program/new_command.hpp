#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

namespace frahm::studies {

struct NewOptions {
  std::string kind;                 // of study
  std::filesystem::path file = {};  // "-": standard output; empty: <kind>.toml here
};

// Writes a commented study of a kind to start from; never over a file. Returns 0. Throws StudyError for an
// unknown kind and a file that is there, engine::IoError.
int new_command(const NewOptions& options, std::ostream& out);

}  // namespace frahm::studies
