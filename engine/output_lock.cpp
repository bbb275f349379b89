#include "engine/output_lock.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "engine/io_error.hpp"

namespace frahm::engine {

namespace {

// A file of that name which is no lock is somebody's work: the lock of a process begins with its name.
void refuse_foreign_file(const File& file) {
  constexpr std::string_view begin = "process ";
  std::array<char, begin.size()> text{};
  const std::size_t size = file.read_at(0, std::as_writable_bytes(std::span(text)));
  const bool is_lock = begin.starts_with(std::string_view(text.data(), size)) ||
                       file.holds_only_zeros();  // after a power failure
  if (is_lock && file.size() <= owner_size) return;
  throw IoError(file.path(), "exists already and is not a lock of frahm; remove or rename it");
}

}  // namespace

OutputLock::OutputLock(const std::filesystem::path& output) : file_(open_locked(lock_path(output), 0)) {
  refuse_foreign_file(file_);
  const std::string owner = this_process();
  file_.truncate(0);
  file_.write_at(0, std::as_bytes(std::span(owner)));
}

OutputLock::~OutputLock() {
  std::error_code ignored;  // a file that is left is harmless: it is the lock that counts
  std::filesystem::remove(file_.path(), ignored);
}

std::filesystem::path lock_path(const std::filesystem::path& output) {
  return output.string() + ".frahm-lock";
}

}  // namespace frahm::engine
