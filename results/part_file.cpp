#include "results/part_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "results/store_error.hpp"

namespace frahm::results {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int error) {
  throw StoreError(path.string(), what, std::strerror(error));
}

// named: the path given in messages.
void sync(const std::filesystem::path& path, int flags, const std::filesystem::path& named) {
  const bool is_directory = (flags & O_DIRECTORY) != 0;
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0)
    fail(named, is_directory ? "cannot open its directory to sync" : "cannot open to sync", errno);
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  // Some file systems cannot sync a directory and return EINVAL: nothing more can be done then.
  if (error == 0 || (error == EINVAL && is_directory)) return;
  fail(named, is_directory ? "cannot sync its directory" : "cannot sync", error);
}

}  // namespace

PartFile::~PartFile() {
  if (published_) return;
  std::error_code none;  // ignored: the part may never have been created
  std::filesystem::remove(part_, none);
}

void PartFile::publish() {
  sync(part_, O_RDWR, part_);
  if (std::rename(part_.c_str(), path_.c_str()) != 0) fail(path_, "cannot rename the part to it", errno);
  published_ = true;
  const std::filesystem::path directory = path_.parent_path();
  sync(directory.empty() ? "." : directory, O_RDONLY | O_DIRECTORY, path_);
}

}  // namespace frahm::results
