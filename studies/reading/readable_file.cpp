#include "studies/reading/readable_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <ios>
#include <iterator>

#include "studies/reading/study_source.hpp"

namespace frahm::studies {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw StudyError(rules::unreadable_file, "{}: cannot be read: {}", name, why);
}

std::ifstream open_file(const std::filesystem::path& path, const std::string& name) {
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(name, std::strerror(errno));
  std::error_code ignored;  // reading reports the error
  if (std::filesystem::is_directory(path, ignored)) refuse(name, "it is a directory");
  return file;
}

}  // namespace

std::string read_file(const std::filesystem::path& path, const std::string& name) {
  std::ifstream file = open_file(path, name);
  try {
    return std::string(std::istreambuf_iterator<char>(file), {});
  } catch (const std::ios_base::failure& failure) {  // of the buffer itself: a disk that cannot read
    refuse(name, failure.code().message());
  }
}

void check_readable(const std::filesystem::path& path, const std::string& name) {
  open_file(path, name);
}

}  // namespace frahm::studies
