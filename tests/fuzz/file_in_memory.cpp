#include "tests/fuzz/file_in_memory.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace frahm::fuzz {

FileInMemory::FileInMemory(std::span<const std::uint8_t> bytes)
    : descriptor_(::memfd_create("input", MFD_CLOEXEC)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0) throw std::system_error(errno, std::generic_category(), "write");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

FileInMemory::~FileInMemory() {
  ::close(descriptor_);
}

std::filesystem::path FileInMemory::path() const {
  return fmt::format("/proc/self/fd/{}", descriptor_);
}

}  // namespace frahm::fuzz
