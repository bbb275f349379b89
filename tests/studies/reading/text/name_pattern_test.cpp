#include "studies/reading/text/name_pattern.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace name_pattern_test {
namespace {

using frahm::studies::hint_of_unmatched;
using frahm::studies::matches;
using frahm::studies::matching;

TEST_CASE("a pattern that matches nothing says where its star stops") {
  const std::vector<std::string> names{"main_velocity_peak", "floor1_peak", "status"};
  CHECK_FALSE(matches("floor*", "floor1_peak"));
  CHECK(matches("floor*_*", "floor1_peak"));
  CHECK_THAT(
      hint_of_unmatched("floor*", names),
      Catch::Contains("stops at \"_\"") && Catch::Contains("\"floor1_peak\" is matched by \"floor*_*\""));
  CHECK_THAT(hint_of_unmatched("*_peek", names), Catch::Contains("stops at \"_\""));
  CHECK(matches("*_*_peak", "main_velocity_peak"));
  CHECK_THAT(hint_of_unmatched("statu", names), Catch::Contains("did you mean \"status\"?"));
}

TEST_CASE("names are found in the order of what names them, each once") {
  using Names = std::vector<std::string>;
  const Names names{"floor1_peak", "status", "floor2_peak"};
  CHECK(matching(Names{"status", "floor*_peak", "floor2_peak", "none"}, names) ==
        Names{"status", "floor1_peak", "floor2_peak"});
  CHECK(matching(Names{}, names).empty());
}

}  // namespace
}  // namespace name_pattern_test
