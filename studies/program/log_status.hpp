#pragma once

#include <filesystem>
#include <iosfwd>
#include <vector>

#include "engine/fingerprint.hpp"

namespace frahm::studies {

// Prints the progress of an unfinished output from its shard logs: points done, failed and missing, who is at
// work, the rate and the time left, and which tasks of an array to submit again. If the note of the study is
// missing or the study has changed, tiles are counted instead of points. logs: all of one study. Throws
// engine::IoError.
void print_log_status(const std::filesystem::path& output, const std::vector<std::filesystem::path>& logs,
                      const engine::LogHeader& study, std::ostream& out);

}  // namespace frahm::studies
