#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace frahm::studies {

// A study may come through a pipe, which its caller named. A file that a study names may not: the study may
// come from a stranger, and a pipe or an endless device would be waited for.
enum class FileKind { regular, any };

// The text of a study, or of a file that it names.  name: of the file, for messages.
// Throws StudyError, `name: cannot be read: why`.
std::string read_file(const std::filesystem::path& path, const std::string& name,
                      FileKind kind = FileKind::regular);

// Throws the same error for a file that another library opens.
void check_readable(const std::filesystem::path& path, const std::string& name);

// The files that this process has read or checked by these functions: no output of it may replace one.
std::vector<std::filesystem::path> files_read();

}  // namespace frahm::studies
