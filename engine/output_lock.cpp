#include "engine/output_lock.hpp"

#include <span>
#include <string>
#include <system_error>

namespace frahm::engine {

OutputLock::OutputLock(const std::filesystem::path& output) : file_(open_locked(lock_path(output), 0)) {
  const std::string owner = this_process();
  file_.truncate(0);
  file_.write_at(0, std::as_bytes(std::span(owner)));
}

OutputLock::~OutputLock() {
  std::error_code ignored;  // a file left behind is harmless: it is the lock that counts
  std::filesystem::remove(file_.path(), ignored);
}

std::filesystem::path lock_path(const std::filesystem::path& output) {
  return output.string() + ".frahm-lock";
}

}  // namespace frahm::engine
