#include "studies/whole_file.hpp"

#include <cerrno>
#include <fstream>
#include <system_error>

#include "engine/io_error.hpp"

namespace frahm::studies {
namespace {

void write_file(const std::filesystem::path& path, std::string_view text) {
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) throw engine::IoError(path, "create", errno);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) throw engine::IoError(path, "write", errno);
}

}  // namespace

void write_whole_file(const std::filesystem::path& path, std::string_view text) {
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    return write_file(path, text);
  }
  std::filesystem::path part = path;
  part += ".part";
  try {
    write_file(part, text);
  } catch (const engine::IoError&) {
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

}  // namespace frahm::studies
