#include "studies/program/whole_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "engine/io_error.hpp"
#include "studies/reading/study_source.hpp"

namespace frahm::studies {
namespace {

void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) throw engine::IoError(path, "create", errno);
  write(file);
  file.close();
  if (!file) throw engine::IoError(path, "write", errno);
}

}  // namespace

void write_whole_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw engine::IoError(path, "create", EISDIR);
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    return write_file(path, write);
  }
  std::filesystem::path part = path;
  part += ".part";
  try {
    write_file(part, write);
  } catch (...) {
    std::filesystem::remove(part, error);
    throw;
  }
  std::filesystem::rename(part, path, error);
  if (error) {
    const int reason = error.value();
    std::filesystem::remove(part, error);
    throw engine::IoError(path, "create", reason);
  }
}

void write_whole_file(const std::filesystem::path& path, std::string_view text) {
  write_whole_file(
      path, [&](std::ostream& file) { file.write(text.data(), static_cast<std::streamsize>(text.size())); });
}

void check_output_is_not_input(const std::filesystem::path& output, const std::filesystem::path& input,
                               std::string_view extension) {
  std::error_code error;
  if (std::filesystem::equivalent(output, input, error)) {
    throw StudyError(rules::wrong_file, "{}: is the file that is read; name another for the output",
                     output.string());
  }
  if (output.extension() == ".toml" || output.extension() == ".h5") {
    throw StudyError(rules::wrong_file, "{}: has the name of a study or a result; name this output {}",
                     output.string(), extension);
  }
}

}  // namespace frahm::studies
