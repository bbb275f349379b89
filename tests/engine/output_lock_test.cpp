#include "engine/output_lock.hpp"

#include <catch2/catch.hpp>

#include "engine/io_error.hpp"
#include "tests/engine/sample_job.hpp"

namespace output_lock_test {
using namespace frahm::engine;
using Catch::Matchers::Contains;

TEST_CASE("only one process at a time makes an output, and the other is told which") {
  const Scratch scratch;
  {
    const OutputLock lock(scratch.output());
    CHECK(std::filesystem::exists(lock_path(scratch.output())));
    CHECK_THROWS_WITH(OutputLock(scratch.output()),
                      Contains("map.h5.frahm-lock") && Contains(this_process()));
  }
  CHECK(std::filesystem::is_empty(scratch.directory()));
  const OutputLock again(scratch.output());
}

TEST_CASE("a lock file that a killed process has left is taken over and goes") {
  const Scratch scratch;
  std::ofstream(lock_path(scratch.output())) << "process 1 on a node that is no more, with a very long name";
  {
    const OutputLock lock(scratch.output());
    std::ifstream file(lock_path(scratch.output()));
    CHECK(std::string(std::istreambuf_iterator<char>(file), {}) == this_process());
  }
  CHECK(std::filesystem::is_empty(scratch.directory()));
}

TEST_CASE("a lock file whose bytes a power failure left as zeros is taken over and goes") {
  const Scratch scratch;
  std::ofstream(lock_path(scratch.output())) << std::string(40, '\0');
  { const OutputLock lock(scratch.output()); }
  CHECK(std::filesystem::is_empty(scratch.directory()));
}

TEST_CASE("a file of the lock's name that is no lock is refused and stays as it is") {
  const Scratch scratch;
  const std::string work = "measured by hand";
  std::ofstream(lock_path(scratch.output())) << work;
  CHECK_THROWS_WITH(OutputLock(scratch.output()),
                    Contains("map.h5.frahm-lock") && Contains("is not a lock of frahm"));
  std::ifstream file(lock_path(scratch.output()));
  CHECK(std::string(std::istreambuf_iterator<char>(file), {}) == work);
}
}  // namespace output_lock_test
