#include "studies/reading/quantities/unit_words.hpp"

#include <catch2/catch.hpp>

namespace unit_words_test {
namespace {

using frahm::studies::in_brackets;
using frahm::studies::with_unit;

TEST_CASE("Numbers and names are told with their units, pure numbers without") {
  CHECK(with_unit(3.2, "mm") == "3.2 mm");
  CHECK(with_unit("3.20", "mm") == "3.20 mm");
  CHECK(in_brackets("stroke", "mm") == "stroke [mm]");
  for (const char* of_pure_number : {"", "1"}) {
    CHECK(with_unit(0.5, of_pure_number) == "0.5");
    CHECK(with_unit("0.50", of_pure_number) == "0.50");
    CHECK(in_brackets("share", of_pure_number) == "share");
  }
}

}  // namespace
}  // namespace unit_words_test
