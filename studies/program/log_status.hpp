#pragma once

#include <filesystem>
#include <iosfwd>
#include <vector>

#include "engine/fingerprint.hpp"

namespace frahm::studies {

// Tells how far an unfinished output is by its shard logs: points done, failed and missing, who is at work,
// how fast and how long still, and which tasks of an array are to be submitted again. Where the note of the
// study is gone, or the study no longer what it was, tiles stand for points. logs: all of one study. Throws
// engine::IoError.
void print_log_status(const std::filesystem::path& output, const std::vector<std::filesystem::path>& logs,
                      const engine::LogHeader& study, std::ostream& out);

}  // namespace frahm::studies
