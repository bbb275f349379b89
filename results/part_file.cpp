#include "results/part_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <random>
#include <string_view>
#include <system_error>
#include <utility>

#include "results/store_error.hpp"
#include "results/write_whole.hpp"

namespace frahm::results {
namespace {

constexpr std::string_view mark = ".part-";
constexpr std::size_t random_digits = 8;

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int error) {
  throw StoreError(path.string(), what, std::strerror(error));
}

std::string random_name(const std::filesystem::path& path) {
  const std::uint32_t random = std::random_device{}();
  return fmt::format("{}{}{:08x}{:08x}", path.string(), mark, random, ~random);
}

// Eight hex digits as a number; nothing for other text.
std::optional<std::uint32_t> number_of(std::string_view digits) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

bool is_named_as_part(std::string_view name, std::string_view output) {
  if (!name.starts_with(output) || !name.substr(output.size()).starts_with(mark)) return false;
  name.remove_prefix(output.size() + mark.size());
  if (name.size() != 2 * random_digits) return false;
  const auto random = number_of(name.substr(0, random_digits));
  const auto complement = number_of(name.substr(random_digits));
  return random && complement && *random == ~*complement;
}

// Removes a file that is named as a part, if it is a plain file and nobody writes it.
void remove_if_dead(const std::filesystem::path& part) {
  const int descriptor = ::open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  const bool is_plain = ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink == 1;
  if (is_plain && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(part.c_str());
  ::close(descriptor);
}

bool is_there(const std::filesystem::path& path) {
  struct stat ignored {};
  return ::lstat(path.c_str(), &ignored) == 0;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.parent_path();
  return folder.empty() ? "." : folder;
}

void sync_folder(const std::filesystem::path& path) {
  const int descriptor = ::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) fail(path, "cannot open its directory to sync", errno);
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  // Some file systems cannot sync a directory and return EINVAL: nothing more can be done then.
  if (error != 0 && error != EINVAL) fail(path, "cannot sync its directory", error);
}

}  // namespace

PartFile::PartFile(std::filesystem::path path) : path_(std::move(path)) {
  remove_dead_parts(path_);
  constexpr int most_attempts = 100;
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    if (create()) return;
  }
  throw StoreError(path_.string(), "cannot create a file next to it", "others take it away");
}

// False if another process took the part for a dead one before it was locked.
bool PartFile::create() {
  part_ = random_name(path_);
  descriptor_ = ::open(part_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    // On a network it can be taken while it is created.
    if (errno == ENOENT && is_there(folder_of(path_))) return false;
    fail(path_, "cannot create a file next to it", errno);
  }
  // On a file system without locks this fails, and nobody removes the part of anybody else.
  ::flock(descriptor_, LOCK_EX | LOCK_NB);
  struct stat own {
  }, replaced{};
  if (::stat(part_.c_str(), &own) != 0) {
    ::close(std::exchange(descriptor_, -1));
    return false;
  }
  if (::lstat(path_.c_str(), &replaced) == 0 && S_ISREG(replaced.st_mode))
    ::fchmod(descriptor_,
             replaced.st_mode & 07777);  // where it fails, the rights of a new file are right too
  return true;
}

PartFile::~PartFile() {
  if (!published_) ::unlink(part_.c_str());
  if (descriptor_ >= 0) ::close(descriptor_);
}

void PartFile::write(std::string_view text) {
  if (const int error = write_whole(descriptor_, text)) give_up("cannot write", error);
}

void PartFile::publish() {
  if (::fsync(descriptor_) != 0) give_up("cannot sync its part", errno);
  if (std::rename(part_.c_str(), path_.c_str()) != 0) give_up("cannot rename the part to it", errno);
  published_ = true;
  sync_folder(path_);
}

void PartFile::give_up(const char* what, int error) const {
  if (!is_there(part_)) throw PartTaken(path_.string(), what, std::strerror(error));
  fail(path_, what, error);
}

void remove_dead_parts(const std::filesystem::path& path) {
  const std::filesystem::path folder = folder_of(path);
  const std::string output = path.filename().string();
  std::error_code error;  // of a folder that cannot be listed: creating the part fails too, and says so
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    if (is_named_as_part(entry->path().filename().string(), output))
      remove_if_dead(folder / entry->path().filename());
  }
}

}  // namespace frahm::results
