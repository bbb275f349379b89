#include "studies/reading/study/profile.hpp"

#include <catch2/catch.hpp>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/studies/small_studies.hpp"

namespace profile_test {
namespace {

using namespace frahm::studies;

std::optional<Profile> profile_of(int storeys, const std::string& report) {
  const Study study = parse_study(small_studies::building(storeys, 3, 5) + report, "building.toml");
  return study.sweep()->profile;
}

TEST_CASE("a system of more than eight masses has all of them as its profile, a smaller one none") {
  CHECK_FALSE(profile_of(8, ""));
  const auto profile = profile_of(9, "");
  REQUIRE(profile);
  CHECK(profile->masses == std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7, 8});
  CHECK(profile->height.empty());
  CHECK(profile_of(9, "[report]\nquantities = [\"floor9_peak\"]\n")->masses.size() == 9);
}

TEST_CASE("a profile lists masses from the lowest, or is those whose names match") {
  CHECK(profile_of(4, "[report]\nprofile = [\"floor3\", \"floor1\"]\n")->masses ==
        std::vector<std::size_t>{2, 0});
  CHECK(profile_of(12, "[report]\nprofile = \"floor1*\"\n")->masses ==
        std::vector<std::size_t>{0, 9, 10, 11});
  CHECK(profile_of(3, "[report]\nprofile = \"all\"\n")->masses.size() == 3);
}

TEST_CASE("heights are one for each mass, or that of every storey") {
  const std::string all = "[report]\nprofile = \"all\"\n";
  CHECK(profile_of(3, all + "height = 3.5\n")->height == std::vector<double>{3.5, 7.0, 10.5});
  CHECK(profile_of(3, all + "height = [4, 7, 10.5]\n")->height == std::vector<double>{4.0, 7.0, 10.5});
}

}  // namespace
}  // namespace profile_test
