#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace frahm::studies {

// Writes a file whole or not at all: under another name beside it, then renamed. A device or a pipe at the
// path is written to directly. Throws engine::IoError.
void write_whole_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
void write_whole_file(const std::filesystem::path& path, std::string_view text);

// Throws StudyError if an output would replace the file it is made from, a study or a result. extension: that
// of such outputs.
void check_output_is_not_input(const std::filesystem::path& output, const std::filesystem::path& input,
                               std::string_view extension = ".csv");

}  // namespace frahm::studies
