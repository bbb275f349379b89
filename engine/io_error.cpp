#include "engine/io_error.hpp"

#include <fmt/format.h>

#include <system_error>

namespace frahm::engine {

IoError::IoError(const std::filesystem::path& path, const std::string& operation, int errno_value)
    : std::runtime_error(fmt::format("cannot {} {}: {}", operation, path.string(),
                                     std::generic_category().message(errno_value))),
      path_(path) {}

IoError::IoError(const std::filesystem::path& path, const std::string& problem)
    : std::runtime_error(fmt::format("{}: {}", path.string(), problem)), path_(path) {}

Locked::Locked(const std::filesystem::path& path, const std::string& owner)
    : IoError(path, fmt::format("in use by {}; only one process at a time may hold it",
                                owner.empty() ? "another process" : owner)) {}

}  // namespace frahm::engine
