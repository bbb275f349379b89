#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <utility>

#include "results/map_reader.hpp"
#include "results/store_error.hpp"
#include "sample.hpp"
#include "temporary_directory.hpp"

namespace test_full_disk {
#ifdef __SANITIZE_ADDRESS__
namespace {
bool is_child = false;
}
// HDF5 1.10.8 does not free a file that it cannot flush; twenty lines of C without us show the same. Only the
// child has such a file, so only the child's leaks are not looked for.
extern "C" int __lsan_is_turned_off() {
  return is_child ? 1 : 0;
}
#endif

namespace {

// Writes the sample while no file may grow beyond `limit` bytes. Returns what the StoreError says, if there
// is one.
std::string refusal_of_full_disk(const std::filesystem::path& path, rlim_t limit) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit files{};
  ::getrlimit(RLIMIT_FSIZE, &files);
  const rlim_t before = std::exchange(files.rlim_cur, limit);
  ::setrlimit(RLIMIT_FSIZE, &files);
  std::string what;
  try {
    sample::write(path);
  } catch (const frahm::results::StoreError& error) {
    what = error.what();
  }
  files.rlim_cur = before;
  ::setrlimit(RLIMIT_FSIZE, &files);
  return what;
}

struct Child {
  int wait_status = 0;
  std::string message;  // of the StoreError; empty if there was none
};

// Does so in a process of its own, which ends as a program does: HDF5 by itself would crash there.
Child write_to_full_disk(const std::filesystem::path& path, rlim_t limit,
                         const std::filesystem::path& message) {
  std::cout.flush();
  std::fflush(nullptr);
  const pid_t process = ::fork();
  if (process < 0) throw std::runtime_error("cannot fork");
  if (process == 0) {
#ifdef __SANITIZE_ADDRESS__
    is_child = true;
#endif
    const std::string what = refusal_of_full_disk(path, limit);
    std::ofstream(message) << what;
    std::exit(0);
  }
  Child child;
  ::waitpid(process, &child.wait_status, 0);
  std::ifstream file(message);
  child.message.assign(std::istreambuf_iterator<char>(file), {});
  return child;
}

}  // namespace

TEST_CASE("a disk that fills up is a StoreError at any write and leaves the file before alone") {
  using Catch::Matchers::Contains;
  const std::array<std::uint64_t, 2> origin{0, 0}, whole{sample::designs, sample::frequencies};
  const TemporaryDirectory directory;
  const auto path = directory / "map.h5";
  sample::write(path);
  const std::uintmax_t size = std::filesystem::file_size(path);
  for (std::uintmax_t limit = 0; limit < size; limit += size / 12) {
    const Child child = write_to_full_disk(path, limit, directory / "message");
    INFO("disk full after " << limit << " of " << size << " bytes");
    CHECK(child.wait_status == 0);
    CHECK_THAT(child.message, Contains("map.h5") && Contains("File too large"));
    CHECK(directory.parts() == 0);
    CHECK_NOTHROW(frahm::results::MapReader(path).read(sample::peak, origin, whole));
  }
  const Child enough = write_to_full_disk(path, 2 * size, directory / "message");
  CHECK(enough.wait_status == 0);
  CHECK(enough.message.empty());
}
}  // namespace test_full_disk
