#pragma once

#include <filesystem>
#include <iosfwd>

namespace frahm::studies {

// Prints the content of a finished result file, or the progress in the shard logs next to an unfinished one;
// if both exist, the logs first, because they are newer. Returns 0. Throws engine::IoError if there is
// neither, results::StoreError for a file that is no result.
int status_command(const std::filesystem::path& file, std::ostream& out);

}  // namespace frahm::studies
