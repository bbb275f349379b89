#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace frahm::engine {

// A file could not be read or written as needed. The text names the file, the operation and the system's
// reason.
class IoError : public std::runtime_error {
 public:
  // "cannot <operation> <path>: <text of the errno value>"
  IoError(const std::filesystem::path& path, const std::string& operation, int errno_value);
  // "<path>: <problem>"
  IoError(const std::filesystem::path& path, const std::string& problem);

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Another process (or another run in this one) holds the lock of a file.
class Locked : public IoError {
 public:
  // owner: the holder named in the file ("process 4711 on node17"), or empty.
  Locked(const std::filesystem::path& path, const std::string& owner);
};

}  // namespace frahm::engine
