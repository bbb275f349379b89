#include "studies/reading/text/readable_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <ios>
#include <iterator>
#include <mutex>
#include <set>
#include <system_error>

#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw StudyError(rules::unreadable_file, "{}: cannot be read: {}", name, why);
}

// For all threads.
struct FilesRead {
  std::mutex turn;
  std::set<std::filesystem::path> paths;
};

FilesRead& all_read() {
  static FilesRead files;
  return files;
}

std::ifstream open_file(const std::filesystem::path& path, const std::string& name, FileKind kind) {
  std::error_code ignored;  // opening reports the error
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (kind == FileKind::regular && std::filesystem::exists(status) &&
      !std::filesystem::is_regular_file(status) && !std::filesystem::is_directory(status))
    refuse(name, "it is not a regular file but a pipe or a device");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(name, std::strerror(errno));
  if (std::filesystem::is_directory(status)) refuse(name, "it is a directory");
  const std::lock_guard turn(all_read().turn);
  all_read().paths.insert(path);
  return file;
}

// From a file that may have no end: what a study may have (1 MiB), and a little more.
std::string begin_of(std::ifstream& file) {
  constexpr std::size_t most = std::size_t{2} << 20;  // bytes
  std::string text(most, '\0');
  // The buffer itself throws where the disk cannot read; the stream would keep it to itself.
  text.resize(static_cast<std::size_t>(file.rdbuf()->sgetn(text.data(), static_cast<std::streamsize>(most))));
  return text;
}

}  // namespace

std::string read_file(const std::filesystem::path& path, const std::string& name, FileKind kind) {
  std::ifstream file = open_file(path, name, kind);
  try {
    if (kind == FileKind::any) return begin_of(file);
    return std::string(std::istreambuf_iterator<char>(file), {});
  } catch (const std::ios_base::failure& failure) {  // of the buffer itself: a disk that cannot read
    refuse(name, failure.code().message());
  }
}

void check_readable(const std::filesystem::path& path, const std::string& name) {
  open_file(path, name, FileKind::regular);
}

std::vector<std::filesystem::path> files_read() {
  const std::lock_guard turn(all_read().turn);
  return {all_read().paths.begin(), all_read().paths.end()};
}

}  // namespace frahm::studies
