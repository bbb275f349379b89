// Laws beside those of one number: iwan elements, springs with a cubic part, curves of friction.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "solvers/mechanics/bends.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "solvers/quantities/quantity.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"

namespace law_test {
namespace {

using namespace frahm;
using Catch::Matchers::WithinRel;
using namespace mechanics;
using studies::Study;

constexpr double kSame = 1e-14;

// One mass on a spring of stiffness 1, and one more element.
Study study_of(const std::string& extra, const std::string& spring = "") {
  return studies::parse_study(R"([study]
schema = 1
kind = "sweep"
units = "dimensionless"
[parameters]
r = 1
F = 0.5
K = 3
[[mass]]
name = "main"
mass = 1
[[element]]
name = "spring"
type = "spring"
between = ["ground", "main"]
stiffness = 1
)" + spring + R"(
[[element]]
name = "extra"
between = ["ground", "main"]
)" + extra + R"(
[excitation]
frequency = "r"
[[excitation.force]]
on = "main"
amplitude = 1
[[axis]]
parameter = "r"
from = 0.5
to = 1.5
points = 11
)",
                              "study.toml");
}

mechanics::NetworkValues values_of(const Study& study) {
  std::vector<double> parameters = study.parameters.nominal();
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  return values;
}

TEST_CASE("an iwan element is as many jenkins elements as it has sliders, told by the first") {
  const Study listed =
      study_of("type = \"iwan\"\nstiffnesses = [1, \"K\", 0.5]\nforces = [\"F\", 0.7, \"2*F\"]\n");
  const auto& elements = listed.network.elements;
  REQUIRE(elements.size() == 4);
  for (std::size_t e = 1; e < 4; ++e) {
    CHECK(elements[e].type == ElementType::jenkins);
    CHECK(elements[e].parts == (e == 1 ? 3 : 0));
  }
  const mechanics::NetworkValues values = values_of(listed);
  CHECK(values.element == std::vector<double>{1.0, 1.0, 3.0, 0.5});
  CHECK(values.second == std::vector<double>{0.0, 0.5, 0.7, 1.0});
  CHECK(values.smooth.empty());
  int energies = 0, slipping = 0, stops = 0;
  for (const periodic::Quantity& quantity : periodic::all_quantities(listed.network)) {
    const std::string name = periodic::describe(quantity, listed.network, true).name;
    energies += name == "extra_energy";
    slipping += name == "extra_slipping";
    stops += name == "extra_stops";
  }
  CHECK(energies == 1);
  CHECK(slipping == 1);
  CHECK(stops == 0);
}

TEST_CASE("a distribution shares stiffness and force among its sliders; one alone is the jenkins element") {
  const std::string keys = "stiffness = \"K\"\nforce = \"F\"\n";
  const auto even = values_of(study_of("type = \"iwan\"\ndistribution = \"uniform\"\nelements = 4\n" + keys));
  const auto power =
      values_of(study_of("type = \"iwan\"\ndistribution = \"power\"\nchi = 1\nelements = 2\n" + keys));
  for (std::size_t i = 1; i <= 4; ++i) {
    CHECK_THAT(even.element[i], WithinRel(3.0 / 4.0, kSame));
    CHECK_THAT(even.second[i], WithinRel(0.5 * (2.0 * static_cast<double>(i) - 1.0) / 16.0, kSame));
  }
  CHECK_THAT(power.element[1], WithinRel(3.0 / 4.0, kSame));
  CHECK_THAT(power.element[2], WithinRel(3.0 * 3.0 / 4.0, kSame));
  CHECK_THAT(power.second[1], WithinRel(0.5 / 8.0, kSame));
  CHECK_THAT(power.second[2], WithinRel(0.5 * 7.0 / 8.0, kSame));
  const Study alone = study_of("type = \"iwan\"\ndistribution = \"uniform\"\nelements = 1\n" + keys);
  const Study jenkins = study_of("type = \"jenkins\"\n" + keys);
  CHECK(values_of(alone).element == values_of(jenkins).element);
  CHECK(values_of(alone).second == values_of(jenkins).second);
  CHECK(periodic::all_quantities(alone.network) == periodic::all_quantities(jenkins.network));
}

TEST_CASE("a distribution has its derivatives by stiffness and force") {
  const Study study = study_of(
      "type = \"iwan\"\ndistribution = \"uniform\"\nelements = 2\nstiffness = \"K\"\nforce = \"F\"\n");
  std::vector<double> parameters = study.parameters.nominal();
  mechanics::NetworkValues by_force, by_stiffness;
  differentiate(study.values, study.parameters, parameters, 1, by_force);
  differentiate(study.values, study.parameters, parameters, 2, by_stiffness);
  CHECK(by_force.second == std::vector<double>{0.0, 0.25, 0.75});
  CHECK(by_force.element == std::vector<double>(3, 0.0));
  CHECK(by_stiffness.element == std::vector<double>{0.0, 0.5, 0.5});
}

TEST_CASE("each number of a smooth law has a place of its own") {
  const std::string arctan = "type = \"coulomb\"\nforce = \"F\"\nlaw = \"arctan\"\nslope = 200\n";
  const mechanics::NetworkValues smooth = values_of(study_of(arctan, "cubic = \"0.1*K\""));
  REQUIRE(smooth.smooth.size() == 2);
  CHECK_THAT(smooth.smooth[0].cubic, WithinRel(0.3, kSame));
  CHECK(smooth.smooth[0].slope == 0.0);
  CHECK(smooth.smooth[1].slope == 200.0);
  CHECK(smooth.element[1] == 0.5);
  CHECK(smooth.second == std::vector<double>(2, 0.0));

  const Study falling =
      study_of("type = \"coulomb\"\nlaw = \"stribeck\"\ntable = [[0, 0], [0.1, \"F\"], [1, 0.3]]\n");
  CHECK(falling.network.elements[1].law == ForceLaw::stribeck);
  const mechanics::NetworkValues values = values_of(falling);
  CHECK(values.smooth[1].curve == std::vector<mechanics::CurvePoint>{{0.0, 0.0}, {0.1, 0.5}, {1.0, 0.3}});
  CHECK(values.element[1] == 0.0);
  CHECK_FALSE(mechanics::smooth_laws_are_monotone(falling.network, values));
  CHECK(mechanics::smooth_laws_are_monotone(study_of(arctan).network, values_of(study_of(arctan))));

  const Study exact = study_of("type = \"coulomb\"\nforce = \"F\"\nstatic_force = 0.6\n");
  CHECK(values_of(exact).second[1] == 0.6);
  CHECK(values_of(exact).smooth.empty());
}

TEST_CASE("a static friction that is the kinetic one leaves a system with a single response") {
  const std::string friction = "type = \"coulomb\"\nforce = \"F\"\n";
  for (const char* same : {"", "static_force = \"F\"\n", "static_force = \" F\"\n"}) {
    INFO(same);
    const Study study = study_of(friction + same);
    CHECK_FALSE(study.network.elements[1].has_static_force);
    CHECK_FALSE(may_have_several_responses(study.network));
    CHECK(values_of(study).element[1] == 0.5);
    CHECK(values_of(study).second[1] == 0.0);
  }
  CHECK(may_have_several_responses(study_of(friction + "static_force = \"1.2*F\"\n").network));
}

}  // namespace
}  // namespace law_test
