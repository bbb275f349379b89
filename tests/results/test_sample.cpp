#include <catch2/catch.hpp>
#include <cstdlib>

#include "sample.hpp"
#include "temporary_directory.hpp"

namespace test_sample {
// Hidden: open_everywhere.py runs it with the name of the file to write.
TEST_CASE("the sample file is written where FRAHM_SAMPLE_FILE says", "[.sample]") {
  const char* path = std::getenv("FRAHM_SAMPLE_FILE");
  const TemporaryDirectory directory;
  CHECK_NOTHROW(sample::write(path != nullptr ? std::filesystem::path(path) : directory / "sample.h5"));
}
}  // namespace test_sample
