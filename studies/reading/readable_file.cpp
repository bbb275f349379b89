#include "studies/reading/readable_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "studies/reading/study_source.hpp"

namespace frahm::studies {

std::ifstream open_file(const std::filesystem::path& path, const std::string& name) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw StudyError(fmt::format("{}: cannot be read: {}", name, std::strerror(errno)));
  if (std::filesystem::is_directory(path))
    throw StudyError(fmt::format("{}: cannot be read: it is a directory", name));
  return file;
}

void check_readable(const std::filesystem::path& path, const std::string& name) {
  open_file(path, name);
}

}  // namespace frahm::studies
