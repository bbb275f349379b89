#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <stdexcept>

#include "results/checked_apart.hpp"
#include "results/store_error.hpp"
#include "temporary_directory.hpp"

namespace test_checked_apart {
using namespace frahm::results;
using Catch::Contains;

TEST_CASE("a check that dies of a file is an error with the name of the file") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "file.h5") << "contents";
  for (const int signal : {SIGSEGV, SIGFPE, SIGBUS, SIGABRT, SIGXCPU}) {
    INFO("signal " << signal);
    CHECK_THROWS_WITH(check_apart(directory / "file.h5", {[&] { std::raise(signal); }}),
                      Contains("file.h5") && Contains("is damaged"));
  }
}

TEST_CASE("an error of a check has the same words as if it were thrown here") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "file.h5") << "contents";
  const auto fail = [&] { throw StoreError("file.h5:/x", "is wrong", "as it must be"); };
  CHECK_THROWS_WITH(check_apart(directory / "file.h5", {fail}), "file.h5:/x: is wrong: as it must be");
}

TEST_CASE("a check changes nothing in this process") {
  const TemporaryDirectory directory;
  std::ofstream(directory / "file.h5") << "contents";
  int calls = 0;
  check_apart(directory / "file.h5", {[&] { ++calls; }});
  CHECK(calls == 0);  // it was counted in the child
}

TEST_CASE("a check is found again by its words") {
  for (const FileCheck& check :
       {result_check("map.h5"), opening_check("data.h5"), dataset_check("data.h5", "decay/time", 1),
        dataset_check("data.h5", "matrix", 2)})
    CHECK(check_called(check.words).words == check.words);
  CHECK_THROWS_AS(check_called({"result"}), std::invalid_argument);
  CHECK_THROWS_AS(check_called({"anything", "map.h5"}), std::invalid_argument);
}
}  // namespace test_checked_apart
