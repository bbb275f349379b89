#include "engine/file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "engine/io_error.hpp"

namespace frahm::engine {
namespace {

// Calls a system function again as long as a signal interrupts it.
template <typename Call>
auto uninterrupted(Call call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

// The text that the holder of the lock left in the file; empty if none.
std::string read_owner(const File& file, std::uint64_t owner_at) {
  std::array<char, owner_size> text{};
  file.read_at(owner_at, std::as_writable_bytes(std::span(text)));
  return std::string(text.data(), strnlen(text.data(), text.size()));
}

}  // namespace

File::File(std::filesystem::path path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

File::File(File&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

File::~File() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

File File::open_for_writing(const std::filesystem::path& path) {
  const int descriptor =
      uninterrupted([&] { return ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666); });
  if (descriptor < 0) throw IoError(path, "open for writing", errno);
  return File(path, descriptor);
}

std::optional<File> File::open_if_present(const std::filesystem::path& path) {
  // O_NONBLOCK: a pipe of that name would wait for somebody to write to it.
  const int descriptor =
      uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC); });
  if (descriptor < 0 && errno == ENOENT) return std::nullopt;
  if (descriptor < 0) throw IoError(path, "open for reading", errno);
  File file(path, descriptor);
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && !S_ISREG(status.st_mode))
    throw IoError(path, "is not a regular file but a directory, pipe or device");
  return file;
}

std::uint64_t File::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) throw IoError(path_, "find the size of", errno);
  return static_cast<std::uint64_t>(status.st_size);
}

std::size_t File::read_at(std::uint64_t offset, std::span<std::byte> to) const {
  std::size_t done = 0;
  while (done < to.size()) {
    const ssize_t count = uninterrupted([&] {
      return ::pread(descriptor_, to.data() + done, to.size() - done, static_cast<off_t>(offset + done));
    });
    if (count < 0) throw IoError(path_, "read", errno);
    if (count == 0) break;  // end of the file
    done += static_cast<std::size_t>(count);
  }
  return done;
}

bool File::holds_only_zeros() const {
  std::array<std::byte, 4096> bytes{};
  for (std::uint64_t at = 0;;) {
    const std::size_t count = read_at(at, bytes);
    if (count == 0) return true;
    const auto read = std::span(bytes).first(count);
    if (std::ranges::any_of(read, [](std::byte each) { return each != std::byte{0}; })) return false;
    at += count;
  }
}

void File::write_at(std::uint64_t offset, std::span<const std::byte> from) {
  std::size_t done = 0;
  while (done < from.size()) {
    const ssize_t count = uninterrupted([&] {
      return ::pwrite(descriptor_, from.data() + done, from.size() - done, static_cast<off_t>(offset + done));
    });
    if (count < 0) throw IoError(path_, "write", errno);
    done += static_cast<std::size_t>(count);
  }
}

void File::truncate(std::uint64_t size) {
  if (uninterrupted([&] { return ::ftruncate(descriptor_, static_cast<off_t>(size)); }) != 0) {
    throw IoError(path_, "cut", errno);
  }
}

void File::sync() {
  if (uninterrupted([&] { return ::fdatasync(descriptor_); }) != 0) throw IoError(path_, "sync", errno);
}

bool File::try_lock() {
  if (uninterrupted([&] { return ::flock(descriptor_, LOCK_EX | LOCK_NB); }) == 0) return true;
  if (errno == EWOULDBLOCK) return false;
  throw IoError(path_, "lock", errno);
}

bool File::is_locked() const {
  if (uninterrupted([&] { return ::flock(descriptor_, LOCK_SH | LOCK_NB); }) == 0) {
    ::flock(descriptor_, LOCK_UN);
    return false;
  }
  if (errno == EWOULDBLOCK) return true;
  throw IoError(path_, "look for the lock of", errno);
}

bool File::is_at_its_path() const {
  struct stat here {};
  struct stat there {};
  if (::fstat(descriptor_, &here) != 0) throw IoError(path_, "inspect", errno);
  if (::stat(path_.c_str(), &there) != 0) {
    if (errno == ENOENT) return false;
    throw IoError(path_, "inspect", errno);
  }
  return here.st_dev == there.st_dev && here.st_ino == there.st_ino;
}

File open_locked(const std::filesystem::path& path, std::uint64_t owner_at) {
  using std::chrono::steady_clock;
  const auto give_up = steady_clock::now() + std::chrono::seconds(1);
  for (;;) {
    File file = File::open_for_writing(path);
    if (file.try_lock()) {
      // Its last holder may have removed the file after we had opened it: what we wrote would vanish.
      if (file.is_at_its_path()) return file;
      continue;
    }
    if (steady_clock::now() > give_up) throw Locked(path, read_owner(file, owner_at));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

std::string this_process() {
  std::array<char, 65> host{};  // POSIX: host names have at most 64 bytes on Linux
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
  return fmt::format("process {} on {}", ::getpid(), host.data());
}

void sync_directory(const std::filesystem::path& directory) {
  const int descriptor =
      uninterrupted([&] { return ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  if (descriptor < 0) throw IoError(directory, "open directory", errno);
  const int result = uninterrupted([&] { return ::fsync(descriptor); });
  const int reason = errno;
  ::close(descriptor);
  if (result != 0) throw IoError(directory, "sync directory", reason);
}

std::filesystem::path directory_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

}  // namespace frahm::engine
