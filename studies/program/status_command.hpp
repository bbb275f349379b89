#pragma once

#include <filesystem>
#include <iosfwd>

namespace frahm::studies {

// Tells what a finished result file holds, or how far the shard logs beside an unfinished one are; of
// both the logs first, which are the news. Returns 0.
// Throws engine::IoError if there is neither, results::StoreError for a file that is no result.
int status_command(const std::filesystem::path& file, std::ostream& out);

}  // namespace frahm::studies
