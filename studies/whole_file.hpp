#pragma once

#include <filesystem>
#include <string_view>

namespace frahm::studies {

// Writes a text to a file that appears whole or not at all: under another name beside it, then renamed. Where
// a device or a pipe stands at the path it is written to as it is. Throws engine::IoError.
void write_whole_file(const std::filesystem::path& path, std::string_view text);

}  // namespace frahm::studies
