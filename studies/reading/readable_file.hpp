#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace frahm::studies {

// A file that a study names, opened to read.  name: stands for it in messages.
// Throws StudyError, `name: cannot be read: why`.
std::ifstream open_file(const std::filesystem::path& path, const std::string& name);

// The same error, for a file that another library opens.
void check_readable(const std::filesystem::path& path, const std::string& name);

}  // namespace frahm::studies
