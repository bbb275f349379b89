#include "results/checked_apart.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <string>

#include "results/store_error.hpp"
#include "results/write_whole.hpp"

namespace frahm::results {
namespace {

constexpr rlim_t most_seconds = 5;  // of processor time; the walk through a result takes milliseconds
constexpr rlim_t most_memory = rlim_t{1} << 30;  // [bytes] beyond what the process has
constexpr char passed = 'p', failed = 'f';       // the first byte of the child's answer

std::atomic<bool> is_kept_here = false;

// The program that carries out checks; empty: a child of this one.
std::filesystem::path& checking_program() {
  static std::filesystem::path program;
  return program;
}

// [bytes], 0 if unknown
rlim_t memory_in_use() {
  std::ifstream file("/proc/self/statm");
  rlim_t total = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
  file >> total >> resident >> shared >> text >> library >> data;
  return file ? data * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

void lower_limit(__rlimit_resource resource, rlim_t value) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min(limit.rlim_max, value);
  ::setrlimit(resource, &limit);
}

// The child ends with its parent, leaves no core file, prints nothing, and has bounds.
void restrain_child() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  lower_limit(RLIMIT_CORE, 0);
  lower_limit(RLIMIT_CPU, most_seconds);
#ifdef __SANITIZE_ADDRESS__
  constexpr bool is_bounded = false;  // the sanitizer has terabytes of its own
#else
  constexpr bool is_bounded = true;
#endif
  if (const rlim_t now = memory_in_use(); is_bounded && now > 0) lower_limit(RLIMIT_DATA, now + most_memory);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU}) ::signal(signal, SIG_DFL);
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
}

[[noreturn]] void be_child(int answer, const std::function<FileCheck()>& check) {
  std::string text(1, passed);
  try {
    restrain_child();
    check().carry_out();
  } catch (const std::exception& error) {
    text = failed + std::string(error.what());
  }
  write_whole(answer, text);  // where it fails the parent takes the check for one that ended the process
  ::_exit(0);                 // without the parent's buffers and destructors
}

// Starts the program that carries out checks. Returns its process; -1: it cannot be started.
pid_t begin_program(const std::filesystem::path& program, int answer, const FileCheck& check) {
  std::vector<std::string> words = check.words;
  words.insert(words.begin(), program.string());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t streams;
  ::posix_spawn_file_actions_init(&streams);
  ::posix_spawn_file_actions_adddup2(&streams, answer, STDOUT_FILENO);
  ::posix_spawn_file_actions_addopen(&streams, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = -1;
  const bool is_begun =
      ::posix_spawn(&child, program.c_str(), &streams, nullptr, arguments.data(), environ) == 0;
  ::posix_spawn_file_actions_destroy(&streams);
  return is_begun ? child : -1;
}

pid_t begin_child(int answer, const FileCheck& check) {
  if (!checking_program().empty()) return begin_program(checking_program(), answer, check);
  const pid_t child = ::fork();
  if (child == 0) be_child(answer, [&] { return check; });
  return child;
}

std::string receive(int from) {
  std::string text;
  std::array<char, 4096> some{};
  for (;;) {
    const ssize_t count = ::read(from, some.data(), some.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(some.data(), static_cast<std::size_t>(count));
  }
}

// How a child without an answer ended.
std::string ending(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return fmt::format("reading it does not finish within {} s", most_seconds);
  if (WIFSIGNALED(status)) return fmt::format("reading it ends in \"{}\"", ::strsignal(WTERMSIG(status)));
  return "reading it ends the process";
}

}  // namespace

void keep_checks_here() {
  is_kept_here = true;
}

void check_by(const std::filesystem::path& program) {
  checking_program() = program;
}

void be_checking_program(const std::vector<std::string>& words) {
  keep_checks_here();
  const int answer = ::dup(STDOUT_FILENO);
  be_child(answer, [&] { return check_called(words); });
}

void check_apart(const std::filesystem::path& path, const FileCheck& check) {
  std::error_code unseen;  // no file: the check says so
  const std::filesystem::file_status kind = std::filesystem::status(path, unseen);
  const bool is_regular = std::filesystem::is_regular_file(kind);
  if (std::filesystem::exists(kind) && !is_regular && !std::filesystem::is_directory(kind))
    throw StoreError(path.string(), "is not a regular file but a pipe or a device", "");
  if (is_kept_here || !is_regular) return check.carry_out();
  std::array<int, 2> pipe{};
  const bool has_pipe = ::pipe2(pipe.data(), O_CLOEXEC) == 0;
  const pid_t child = has_pipe ? begin_child(pipe[1], check) : -1;
  if (has_pipe) ::close(pipe[1]);
  if (child < 0) {  // no process to be had: better unguarded than not at all
    if (has_pipe) ::close(pipe[0]);
    return check.carry_out();
  }
  const std::string answer = receive(pipe[0]);
  ::close(pipe[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (answer.empty()) throw StoreError(path.string(), "is damaged", ending(status));
  if (answer.front() == failed) throw StoreError(answer.substr(1));
}

}  // namespace frahm::results
