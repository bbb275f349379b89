// Preloaded into a program (LD_PRELOAD), counts its calls to the system that change files below a folder, or
// that read them, and at a chosen one kills the process or makes the call fail.
//
//   FAULT_FOLDER  the folder, as realpath() gives it; without it nothing is counted
//   FAULT_LOG     file, outside the folder, that is told each call: number, name, offset, bytes, result, path
//   FAULT_COUNT   "changes" (default): write, truncate, create, rename, remove, sync;
//                 "reads": read, open for reading, list a directory, lock
//   FAULT_AT      number of the call, from 1 on; without it the calls are only counted
//   FAULT_DO      "kill_before", "kill_half" (half of the bytes are written), "kill_after": SIGKILL;
//                 "freeze": SIGSTOP before the call, which is carried out when the process goes on;
//                 "short": half of the bytes are transferred, and the call says so;
//                 "fail": the call fails;  "fail_on": this one and all later ones do. Under ENOSPC and EDQUOT
//                 what gives space back still works then.
//   FAULT_ERRNO   number of the error of "fail" and "fail_on"
//   FAULT_SYNCED  keeps copies there of what is synced (synced_copies.hpp); only with FAULT_COUNT "changes"
//   FAULT_RANK    of a program of several MPI ranks only this one is counted (OMPI_COMM_WORLD_RANK)
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "tests/faults/synced_copies.hpp"

namespace {

enum class Fault { none, kill_before, kill_half, kill_after, freeze, short_transfer, fail };
enum class Kind { change, release, read };  // release: a change that needs no space on the disk

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

long number(const char* name) {
  return std::atol(variable(name).c_str());
}

template <typename Function>
Function* original(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

struct Settings {
  std::string folder = variable("FAULT_FOLDER");
  bool reads = variable("FAULT_COUNT") == "reads";
  long at = number("FAULT_AT");
  std::string what = variable("FAULT_DO");
  int error = static_cast<int>(number("FAULT_ERRNO"));
  bool is_this_rank =
      variable("FAULT_RANK").empty() || variable("FAULT_RANK") == variable("OMPI_COMM_WORLD_RANK");
  int log = -1;

  Settings() {
    const std::string path = variable("FAULT_LOG");
    if (path.empty()) return;
    log = original<decltype(::open)>("open")(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  }
};

const Settings& settings() {
  static const Settings once;
  return once;
}

// A counted call; number 0: it is none of those that are counted.
struct Call {
  long number = 0;
  const char* name = "";
  std::string path;
  long long offset = -1;
  std::size_t bytes = 0;
  Fault fault = Fault::none;
};

Fault fault_at(long number, Kind kind) {
  const Settings& set = settings();
  if (set.at == 0 || number < set.at) return Fault::none;
  if (set.what == "fail_on") {
    const bool disk_full = set.error == ENOSPC || set.error == EDQUOT;
    return disk_full && kind == Kind::release ? Fault::none : Fault::fail;
  }
  if (number > set.at) return Fault::none;
  if (set.what == "fail") return Fault::fail;
  if (set.what == "freeze") return Fault::freeze;
  if (set.what == "short") return Fault::short_transfer;
  if (set.what == "kill_before") return Fault::kill_before;
  if (set.what == "kill_half") return Fault::kill_half;
  return Fault::kill_after;
}

Call counted(const char* name, Kind kind, std::string path, std::size_t bytes = 0, long long offset = -1) {
  static std::atomic<long> count = 0;
  const Settings& set = settings();
  const bool is_below = !set.folder.empty() && path.starts_with(set.folder) &&
                        (path.size() == set.folder.size() || path[set.folder.size()] == '/');
  if (!is_below || (kind == Kind::read) != set.reads || !set.is_this_rank) return {};
  const long number = ++count;
  return {number, name, std::move(path), offset, bytes, fault_at(number, kind)};
}

void tell(const Call& call, const std::string& result) {
  if (call.number == 0 || settings().log < 0) return;
  const int error = errno;
  const std::string line = std::to_string(call.number) + ' ' + call.name + ' ' + std::to_string(call.offset) +
                           ' ' + std::to_string(call.bytes) + ' ' + result + ' ' + call.path + '\n';
  static const auto write = original<decltype(::write)>("write");
  [[maybe_unused]] const ssize_t told = write(settings().log, line.data(), line.size());
  errno = error;
}

[[noreturn]] void die(const Call& call, const char* when) {
  tell(call, when);
  ::kill(::getpid(), SIGKILL);
  for (;;) ::pause();
}

// Carries out a call that moves no bytes.  failure: what it returns when it fails.
template <typename Real, typename Result>
Result carry_out(const Call& call, Result failure, Real real) {
  switch (call.fault) {
    case Fault::kill_before:
    case Fault::kill_half:
      die(call, "killed_before");
    case Fault::fail:
      errno = settings().error;
      tell(call, "failed");
      return failure;
    case Fault::freeze:
      ::kill(::getpid(), SIGSTOP);
      break;
    default:
      break;
  }
  const Result result = real();
  if (call.fault == Fault::kill_after) die(call, "killed_after");
  tell(call, result == failure ? "failed" : "done");
  return result;
}

// Carries out a call that moves bytes; real(bytes) moves so many.
template <typename Real>
ssize_t transfer(const Call& call, std::size_t bytes, Real real) {
  const bool half = call.fault == Fault::short_transfer && bytes > 1;
  if (call.fault == Fault::kill_half) {
    real(bytes / 2);
    die(call, "killed_half");
  }
  return carry_out(call, ssize_t{-1}, [&]() -> ssize_t { return real(half ? bytes / 2 : bytes); });
}

std::string path_of(int descriptor) {
  const int error = errno;
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  std::array<char, PATH_MAX> path{};
  const ssize_t size = ::readlink(link.c_str(), path.data(), path.size());
  errno = error;
  return size < 0 ? "" : std::string(path.data(), static_cast<std::size_t>(size));
}

// The path with links resolved; the file itself need not be there.
std::string path_of(const char* path, int directory = AT_FDCWD) {
  const int error = errno;
  std::string whole = path;
  if (whole.empty() || whole.front() != '/')
    whole = (directory == AT_FDCWD ? std::string(".") : path_of(directory)) + '/' + whole;
  std::array<char, PATH_MAX> real{};
  const bool is_there = ::realpath(whole.c_str(), real.data()) != nullptr;
  const std::size_t slash = whole.rfind('/');
  const bool has_folder = !is_there && ::realpath(whole.substr(0, slash + 1).c_str(), real.data()) != nullptr;
  errno = error;
  if (is_there) return real.data();
  return has_folder ? std::string(real.data()) + whole.substr(slash) : whole;
}

ssize_t write_through(int descriptor, const void* from, std::size_t bytes) {
  static const auto real = original<decltype(::write)>("write");
  return transfer(counted("write", Kind::change, path_of(descriptor), bytes), bytes,
                  [&](std::size_t part) { return real(descriptor, from, part); });
}

ssize_t write_at(int descriptor, const void* from, std::size_t bytes, off_t offset) {
  static const auto real = original<decltype(::pwrite)>("pwrite");
  return transfer(counted("pwrite", Kind::change, path_of(descriptor), bytes, offset), bytes,
                  [&](std::size_t part) { return real(descriptor, from, part, offset); });
}

// The pieces are written one by one: what is faulty is faulty for all of them together.
std::size_t size_of(const iovec* pieces, int count) {
  std::size_t bytes = 0;
  for (int i = 0; i < count; ++i) bytes += pieces[i].iov_len;
  return bytes;
}

std::string joined(const iovec* pieces, int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i)
    bytes.append(static_cast<const char*>(pieces[i].iov_base), pieces[i].iov_len);
  return bytes;
}

ssize_t read_at(int descriptor, void* to, std::size_t bytes, off_t offset) {
  static const auto real = original<decltype(::pread)>("pread");
  return transfer(counted("pread", Kind::read, path_of(descriptor), bytes, offset), bytes,
                  [&](std::size_t part) { return real(descriptor, to, part, offset); });
}

int truncate_to(int descriptor, off_t size) {
  static const auto real = original<decltype(::ftruncate)>("ftruncate");
  return carry_out(counted("ftruncate", Kind::release, path_of(descriptor), 0, size), -1,
                   [&] { return real(descriptor, size); });
}

int sync_with(const char* name, int (*real)(int), int descriptor) {
  const Call call = counted(name, Kind::change, path_of(descriptor));
  return carry_out(call, -1, [&] {
    const int result = real(descriptor);
    if (call.number > 0 && result == 0) keep_synced(descriptor, call.path);
    return result;
  });
}

int open_at(int directory, const char* path, int flags, mode_t mode) {
  static const auto real = original<decltype(::openat)>("openat");
  const bool creates = (flags & (O_CREAT | O_TRUNC)) != 0;
  return carry_out(
      counted(creates ? "create" : "open", creates ? Kind::change : Kind::read, path_of(path, directory)), -1,
      [&] { return real(directory, path, flags, mode); });
}

FILE* open_stream(const char* path, const char* mode) {
  static const auto real = original<decltype(::fopen)>("fopen");
  const bool creates = std::string_view(mode).find_first_of("wa") != std::string_view::npos;
  return carry_out(counted(creates ? "create" : "open", creates ? Kind::change : Kind::read, path_of(path)),
                   static_cast<FILE*>(nullptr), [&] { return real(path, mode); });
}

// The third argument of open(), which is there when a file may be created.
mode_t mode_of(int flags, va_list more) {
  return (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
}

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* from, size_t bytes) {
  return write_through(descriptor, from, bytes);
}

ssize_t pwrite(int descriptor, const void* from, size_t bytes, off_t offset) {
  return write_at(descriptor, from, bytes, offset);
}

ssize_t pwrite64(int descriptor, const void* from, size_t bytes, off64_t offset) {
  return write_at(descriptor, from, bytes, offset);
}

ssize_t writev(int descriptor, const iovec* pieces, int count) {
  static const auto real = original<decltype(::writev)>("writev");
  const std::size_t all = size_of(pieces, count);
  return transfer(counted("writev", Kind::change, path_of(descriptor), all), all,
                  [&](std::size_t part) -> ssize_t {
                    if (part == all) return real(descriptor, pieces, count);
                    static const auto real_write = original<decltype(::write)>("write");
                    return real_write(descriptor, joined(pieces, count).data(), part);
                  });
}

int ftruncate(int descriptor, off_t size) noexcept {
  return truncate_to(descriptor, size);
}

int ftruncate64(int descriptor, off64_t size) noexcept {
  return truncate_to(descriptor, size);
}

int rename(const char* from, const char* to) noexcept {
  static const auto real = original<int(const char*, const char*)>("rename");
  return carry_out(counted("rename", Kind::change, path_of(to)), -1, [&] { return real(from, to); });
}

int unlink(const char* path) noexcept {
  static const auto real = original<int(const char*)>("unlink");
  return carry_out(counted("unlink", Kind::release, path_of(path)), -1, [&] { return real(path); });
}

int unlinkat(int directory, const char* path, int flags) noexcept {
  static const auto real = original<int(int, const char*, int)>("unlinkat");
  return carry_out(counted("unlink", Kind::release, path_of(path, directory)), -1,
                   [&] { return real(directory, path, flags); });
}

int remove(const char* path) noexcept {
  static const auto real = original<int(const char*)>("remove");
  return carry_out(counted("unlink", Kind::release, path_of(path)), -1, [&] { return real(path); });
}

int fsync(int descriptor) {
  static const auto real = original<int(int)>("fsync");
  return sync_with("fsync", real, descriptor);
}

int fdatasync(int descriptor) {
  static const auto real = original<int(int)>("fdatasync");
  return sync_with("fdatasync", real, descriptor);
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_at(AT_FDCWD, path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_at(AT_FDCWD, path, flags, mode);
}

int openat(int directory, const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_at(directory, path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  return open_stream(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  return open_stream(path, mode);
}

ssize_t read(int descriptor, void* to, size_t bytes) {
  static const auto real = original<decltype(::read)>("read");
  return transfer(counted("read", Kind::read, path_of(descriptor), bytes), bytes,
                  [&](std::size_t part) { return real(descriptor, to, part); });
}

ssize_t pread(int descriptor, void* to, size_t bytes, off_t offset) {
  return read_at(descriptor, to, bytes, offset);
}

ssize_t pread64(int descriptor, void* to, size_t bytes, off64_t offset) {
  return read_at(descriptor, to, bytes, offset);
}

int flock(int descriptor, int operation) noexcept {
  static const auto real = original<int(int, int)>("flock");
  return carry_out(counted("flock", Kind::read, path_of(descriptor)), -1,
                   [&] { return real(descriptor, operation); });
}

}  // extern "C"
