#pragma once

#include <filesystem>
#include <string>

namespace frahm::studies {

// The text of a study, or of a file that it names.  name: of the file, for messages.
// Throws StudyError, `name: cannot be read: why`.
std::string read_file(const std::filesystem::path& path, const std::string& name);

// Throws the same error for a file that another library opens.
void check_readable(const std::filesystem::path& path, const std::string& name);

}  // namespace frahm::studies
