#include "studies/page/profile_group.hpp"

#include <catch2/catch.hpp>

#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"

namespace profile_group_test {
namespace {

using namespace frahm::studies;
namespace results = frahm::results;

Study building(const std::string& report) {
  return parse_study(small_studies::building(4, 2, 5) + "[report]\n" + report, "building.toml");
}

results::GroupContent group_of(const Study& study) {
  return profile_group(study, *study.sweep()->profile);
}

std::string text_of(const results::GroupContent& group, const std::string& name) {
  for (const auto& [key, text] : group.texts)
    if (key == name) return text;
  return "no " + name;
}

TEST_CASE("a report's profile names its masses, the spring below each, and who owns quantities") {
  const results::GroupContent group = group_of(building("profile = \"all\"\nheight = 3\n"));
  CHECK(text_of(group, "masses") == "floor1,floor2,floor3,floor4");
  CHECK(text_of(group, "springs") == "spring1,spring2,spring3,spring4");
  CHECK(
      text_of(group, "owners") ==
      "floor1,floor2,floor3,floor4,spring1,damper1,spring2,damper2,coulomb2,spring3,damper3,spring4,damper4,"
      "coulomb4");
  REQUIRE(group.columns.size() == 1);
  CHECK(group.columns[0].values == std::vector<double>{3.0, 6.0, 9.0, 12.0});
}

TEST_CASE("a profile that the study has not chosen says which key chooses") {
  const Study chosen = building("profile = \"all\"\n");
  CHECK(text_of(group_of(chosen), "hint") == "no hint");
  const Study all = parse_study(small_studies::building(12, 2, 5), "building.toml");
  CHECK_THAT(text_of(group_of(all), "hint"), Catch::Contains("absorbers too; [report] profile"));
}

TEST_CASE("masses of a profile that no spring joins have none between them") {
  CHECK(text_of(group_of(building("profile = [\"floor2\", \"floor4\", \"floor3\"]\n")), "springs") ==
        ",,spring4");
}

TEST_CASE("a profile is drawn from the peaks and strokes that are recorded") {
  const Study study = building("profile = [\"floor1\", \"floor2\"]\n");
  std::vector<results::Variable> recorded;
  for (const char* name : {"floor2_peak", "floor1_peak", "floor4_peak", "spring2_stroke", "spring3_stroke"})
    recorded.push_back({.name = name, .unit = "1"});
  CHECK(profile_quantities(study, *study.sweep()->profile, recorded) ==
        std::vector<std::string>{"floor1_peak", "floor2_peak", "spring2_stroke"});
}

}  // namespace
}  // namespace profile_group_test
