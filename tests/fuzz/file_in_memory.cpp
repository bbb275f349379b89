#include "tests/fuzz/file_in_memory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

namespace frahm::fuzz {
namespace {

std::filesystem::path place_of_files() {
  const std::filesystem::path memory = "/dev/shm";
  return ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path();
}

}  // namespace

FileInMemory::FileInMemory(std::span<const std::uint8_t> bytes)
    : path_(place_of_files() / fmt::format("frahm-fuzzed-{}", ::getpid())) {
  std::ofstream file(path_, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error(fmt::format("{}: cannot be written", path_.string()));
}

FileInMemory::~FileInMemory() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace frahm::fuzz
