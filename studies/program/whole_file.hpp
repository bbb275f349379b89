#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace frahm::studies {

// Writes a file that appears whole or not at all: under another name beside it, then renamed. Where a device
// or a pipe stands at the path it is written to as it is. Throws engine::IoError.
void write_whole_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
void write_whole_file(const std::filesystem::path& path, std::string_view text);

// An output must not take the place of the file it is made from, nor of a study or a result: throws
// StudyError. extension: that of such outputs.
void check_output_is_not_input(const std::filesystem::path& output, const std::filesystem::path& input,
                               std::string_view extension = ".csv");

}  // namespace frahm::studies
