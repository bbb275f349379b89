#include "studies/reading/study/assignment.hpp"

#include <catch2/catch.hpp>
#include <numbers>
#include <string>

#include "studies/reading/map/grid_check.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/study_path.hpp"

namespace assignment_test {
namespace {

using namespace frahm::studies;

constexpr double rounding = 1e-14;  // a few roundings of double arithmetic

Study rig() {
  return read_study(study_path("rig_atlas"));
}
Study den_hartog() {
  return read_study(study_path("den_hartog"));
}

std::string complaint_about(const Study& study, const std::string& text) {
  try {
    parse_assignments(study, "--at", text);
  } catch (const StudyError& error) {
    return error.what();
  }
  return "none";
}

TEST_CASE("an assignment takes the unit of the axis, else that of the parameter, else its own") {
  const Study study = rig();
  const auto read = parse_assignments(study, "--at", "omega=250, A = 30 ,I=6.36, FP=5 %");
  REQUIRE(read.size() == 4);
  CHECK_THAT(read[0].value, Catch::WithinRel(250.0 * std::numbers::pi / 30.0, rounding));
  CHECK_THAT(read[1].value, Catch::WithinRel(0.030, rounding));
  CHECK(read[2].value == 6.36);
  CHECK_THAT(read[3].value, Catch::WithinRel(0.05, rounding));
  CHECK(parse_assignments(study, "--at", "omega=25 rad/s")[0].value == 25.0);
  CHECK_THAT(parse_assignments(study, "--at", "omega=4Hz")[0].value,
             Catch::WithinRel(8.0 * std::numbers::pi, rounding));
}

TEST_CASE("the unit of a parameter is the one its axis has") {
  const Study study = rig();
  CHECK(usual_unit(study, *study.parameters.find("omega")).text == "rpm");
  CHECK(usual_unit(study, *study.parameters.find("A")).text == "mm");
  CHECK(usual_unit(den_hartog(), 0).text == "1");
}

TEST_CASE("a wrong assignment is told what is wrong and what would be right") {
  const Study study = rig();
  CHECK(complaint_about(study, "omga=250") ==
        "--at \"omga=250\": no parameter is called \"omga\"; did you mean \"omega\"?");
  CHECK_THAT(complaint_about(study, "omega"), Catch::Contains("write name=value"));
  CHECK_THAT(complaint_about(study, "I=6,omega="),
             Catch::StartsWith("--at \"omega=\": \"\" is not a finite number"));
  CHECK_THAT(complaint_about(study, "I=nan"), Catch::Contains("\"nan\" is not a finite number"));
  CHECK_THAT(complaint_about(study, "omega=250 kg"),
             Catch::Contains("a mass, but an angular frequency is expected"));
  CHECK_THAT(complaint_about(study, "I=6,I=7"), Catch::Contains("\"I\" is given twice"));
  CHECK_THAT(complaint_about(study, "I=6,"), Catch::Contains("write name=value"));
  CHECK_THAT(complaint_about(den_hartog(), "r=1 Hz"), Catch::Contains("no meaning in a dimensionless study"));
  CHECK(complaint_about(den_hartog(), "r=0.9,f=0.1") == "none");
}

TEST_CASE("a study with other parameters is checked again") {
  const Study study = den_hartog();
  const Study changed = with_parameters(study, parse_assignments(study, "--set", "f=0.3"));
  CHECK(changed.parameters.nominal()[1] == 0.3);
  CHECK_THROWS_WITH(
      with_parameters(rig(), parse_assignments(rig(), "--set", "A=-1")),
      Catch::Contains("element \"guide\": force: is -0.08181 N at FP = 0.01, K = 8181 N/m, A = -1 mm; "
                      "must be >= 0"));
}

TEST_CASE("a point out of range is told with the value's place in the study") {
  const Study study = den_hartog();
  std::vector<double> parameters{-0.1, 0.2, 0.9};
  CHECK_THROWS_WITH(check_point(study, parameters),
                    Catch::Contains("element \"damper\": damping: is -0.2 at zeta = -0.1; must be >= 0"));
}

}  // namespace
}  // namespace assignment_test
