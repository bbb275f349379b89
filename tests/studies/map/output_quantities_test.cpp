#include "studies/map/output_quantities.hpp"

#include <catch2/catch.hpp>

#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"

namespace output_quantities_test {
namespace {

using namespace frahm::studies;

const std::string base = small_studies::oscillator() + small_studies::axis("r", 0.1, 2, 11);

std::vector<frahm::periodic::Quantity> of(const std::string& text) {
  return output_quantities(parse_study(text, "small.toml"));
}

TEST_CASE("quantities are recorded in the order in which the study lists them") {
  const auto listed = of(base + "[output]\nquantities = [\"status\", \"main_peak\"]\n");
  REQUIRE(listed.size() == 2);
  CHECK(listed[0].measure == frahm::periodic::Measure::status);
  CHECK(listed[1].measure == frahm::periodic::Measure::peak);
}

TEST_CASE("the status is recorded whatever the study lists") {
  const auto listed = of(base + "[output]\nquantities = [\"main_peak\"]\n");
  REQUIRE(listed.size() == 2);
  CHECK(listed[0].measure == frahm::periodic::Measure::peak);
  CHECK(listed[1].measure == frahm::periodic::Measure::status);
}

std::vector<frahm::periodic::QuantityDescription> variables_of(const std::string& text) {
  const Study study = parse_study(text, "small.toml");
  return output_variables(study, output_quantities(study));
}

TEST_CASE("an unknown quantity is refused with its place and the nearest name") {
  CHECK_THROWS_WITH(of(base + "[output]\nquantities = [\"main_peek\"]\n"),
                    Catch::StartsWith("small.toml:40:15: ") && Catch::Contains("there is no \"main_peek\"") &&
                        Catch::Contains("did you mean \"main_peak\"?"));
}

TEST_CASE("a pattern stands for every quantity that it matches, each recorded once") {
  const std::string building = small_studies::building(3, 3, 5);
  const auto listed =
      of(building + "[output]\nquantities = [\"floor2_peak\", \"floor*_peak\", \"status\"]\n");
  REQUIRE(listed.size() == 4);
  CHECK(listed[0].index == 1);
  CHECK(listed[1].index == 0);
  CHECK(listed[2].index == 2);
  CHECK(listed[3].measure == frahm::periodic::Measure::status);
  CHECK_THROWS_WITH(of(building + "[output]\nquantities = [\"storey*_peak\"]\n"),
                    Catch::Contains("there is no \"storey*_peak\""));
}

TEST_CASE("a coordinate may not have the name of a quantity that is recorded") {
  const std::string clash = "[[coordinate]]\nname = \"main_peak\"\nvalue = \"2*r\"\n";
  CHECK_THROWS_WITH(variables_of(base + clash), Catch::Contains("\"main_peak\" is the name of a coordinate"));
  CHECK_NOTHROW(variables_of(base + clash + "[output]\nquantities = [\"status\"]\n"));
}

TEST_CASE("the variables of a comparison follow the quantities, and clash with coordinates as they do") {
  const std::string compare = "[compare]\nlaw = \"arctan\"\nslope = 1e3\n";
  const auto variables = variables_of(base + "[output]\nquantities = [\"status\"]\n" + compare);
  REQUIRE(variables.size() == 4);
  CHECK(variables[1].name == "main_peak_compared");
  CHECK(variables[2].name == "main_peak_difference");
  CHECK(variables[3].name == "status_compared");
  const std::string clash = "[[coordinate]]\nname = \"status_compared\"\nvalue = \"2*r\"\n";
  CHECK_NOTHROW(variables_of(base + clash));
  CHECK_THROWS_WITH(variables_of(base + clash + compare), Catch::Contains("is the name of a coordinate"));
}

TEST_CASE("a coordinate may not have the name of a group of the file, or of what stands in one") {
  const auto clash = [](const std::string& name) {
    return "[[coordinate]]\nname = \"" + name + "\"\nvalue = \"2*r\"\n";
  };
  CHECK_THROWS_WITH(variables_of(base + clash("provenance")), Catch::Contains("and of a group of the file"));
  for (const char* name : {"modes", "mode", "mode_mass", "mode_frequency", "mode_damping"})
    CHECK_THROWS_WITH(variables_of(base + clash(name)), Catch::Contains("rename it"));
  const std::string resonances = "[output]\nresonances = [\"main\"]\n";
  for (const char* name : {"resonance", "curve", "main_half_power_low"}) {
    CHECK_NOTHROW(variables_of(base + clash(name)));
    CHECK_THROWS_WITH(variables_of(base + clash(name) + resonances), Catch::Contains("rename it"));
  }
  for (const char* name : {"borders", "border", "element", "axis", "regime_below", "regime_above"}) {
    CHECK_NOTHROW(variables_of(base + clash(name)));
    CHECK_THROWS_WITH(variables_of(base + clash(name) + "[output]\nborders = true\n"),
                      Catch::Contains("rename it"));
  }
  const std::string orbits = "[output]\norbits = [{ r = 0.5 }]\n";
  for (const char* name : {"orbits", "time", "row_start"}) {
    CHECK_NOTHROW(variables_of(base + clash(name)));
    CHECK_THROWS_WITH(variables_of(base + clash(name) + orbits), Catch::Contains("rename it"));
  }
}

TEST_CASE("the headline is the peak of its mass or the stroke of its element, else the first mass's peak") {
  const auto headline = [](const std::string& report) {
    return headline_of(parse_study(base + report, "small.toml"));
  };
  CHECK(headline("") == "main_peak");
  CHECK(headline("[report]\nheadline = \"main\"\n") == "main_peak");
  CHECK(headline("[report]\nheadline = \"spring\"\n") == "spring_stroke");
  CHECK_THROWS_WITH(variables_of(base + "[report]\nheadline = \"friction\"\n"),
                    Catch::Contains("[report]: headline: this study does not record \"friction_stroke\""));
}

TEST_CASE("a report may only show what is recorded") {
  const std::string chosen = base + "[output]\nquantities = [\"main_peak\"]\n[report]\nquantities = ";
  CHECK_THROWS_WITH(variables_of(chosen + "[\"main_rms\"]\n"),
                    Catch::Contains("[report]: quantities: this study does not record \"main_rms\""));
  CHECK_NOTHROW(variables_of(chosen + "[\"main_peak\"]\n"));
  CHECK_NOTHROW(variables_of(chosen + "[\"main_*\"]\n"));
  CHECK_THROWS_WITH(variables_of(chosen + "[\"main_r*\"]\n"), Catch::Contains("does not record \"main_r*\""));
}

TEST_CASE("a profile may only be of masses whose peaks are recorded, unless nobody asked for it") {
  const std::string chosen = small_studies::building(9, 3, 5) + "[output]\nquantities = [\"floor1_peak\"]\n";
  CHECK_NOTHROW(variables_of(chosen));
  CHECK_THROWS_WITH(
      variables_of(chosen + "[report]\nprofile = \"all\"\n"),
      Catch::Contains("[report]: profile: it shows \"floor2_peak\", which this study does not record"));
}

}  // namespace
}  // namespace output_quantities_test
