#pragma once

#include <filesystem>
#include <string>

namespace frahm::studies {

// The whole of a study, or of a file that a study names.  name: stands for it in messages.
// Throws StudyError, `name: cannot be read: why`.
std::string read_file(const std::filesystem::path& path, const std::string& name);

// The same error, for a file that another library opens.
void check_readable(const std::filesystem::path& path, const std::string& name);

}  // namespace frahm::studies
