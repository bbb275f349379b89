#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "solvers/laws/damper_bend.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "solvers/laws/spring_bend.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"

namespace characteristic_test {
namespace {

using namespace frahm;
using studies::Study;

// One mass on a spring of stiffness 1, and further elements.
Study study_of(const std::string& elements, const std::string& more = "") {
  return studies::parse_study(R"([study]
schema = 1
kind = "sweep"
units = "dimensionless"
[parameters]
r = 1
D = 0.5
k = 3
[[mass]]
name = "main"
mass = 1
[[element]]
name = "spring"
type = "spring"
between = ["ground", "main"]
stiffness = 1
)" + elements + R"(
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
)" + more,
                              "study.toml");
}

std::string element(const std::string& type, const std::string& keys) {
  return "[[element]]\nname = \"extra\"\ntype = \"" + type + "\"\nbetween = [\"ground\", \"main\"]\n" + keys;
}

mechanics::NetworkValues values_at(const Study& study, double D) {
  std::vector<double> parameters = study.parameters.nominal();
  parameters[1] = D;
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  return values;
}

// The force of the second element at rest at u, or at the velocity u, of its value and its bends.
double force_at(const Study& study, const mechanics::NetworkValues& values, double u, double value) {
  double force = value * u;
  const auto& bends = study.network.elements[1].bends;
  for (std::size_t b = 0; b < bends.size(); ++b) {
    const auto& [place, stiffness, damping] = values.bends[1][b];
    const double slope = bends[b].law->of_velocity ? damping : stiffness;
    force += bends[b].side * slope * std::max(0.0, bends[b].side * u - place);
  }
  return force;
}

// The straight line through the two points next to u, or through the first or last two.
double interpolated(const std::vector<std::pair<double, double>>& points, double u) {
  std::size_t i = 0;
  while (i + 2 < points.size() && u > points[i + 1].first) ++i;
  const auto [a, f] = points[i];
  const auto [b, g] = points[i + 1];
  return f + (g - f) * (u - a) / (b - a);
}

constexpr double kExact = 1e-12;

TEST_CASE("a table is the sum of a straight line and its bends, on both sides and beyond its ends") {
  const std::string table =
      "table = [[-2, -9], [-1, -3], [\"-D\", \"-D\"], [0.8, 0.8], [1.5, 0.1], [3, 4]]\n";
  for (const double D : {0.5, 0.3}) {
    const std::vector<std::pair<double, double>> points{{-2, -9},   {-1, -3},   {-D, -D},
                                                        {0.8, 0.8}, {1.5, 0.1}, {3, 4}};
    for (const std::string type : {"spring", "damper"}) {
      const Study study = study_of(element(type, table));
      const auto values = values_at(study, D);
      CHECK_THAT(values.element[1], Catch::WithinAbs(1.0, kExact));
      REQUIRE(study.network.elements[1].bends.size() == 4);
      for (const auto& bend : study.network.elements[1].bends)
        CHECK(bend.law == (type == "spring" ? &laws::spring_bend : &laws::damper_bend));
      for (double u = -4.0; u < 5.0; u += 0.093) {
        INFO(type << ", D " << D << ", u " << u);
        CHECK_THAT(force_at(study, values, u, values.element[1]),
                   Catch::WithinAbs(interpolated(points, u), kExact));
      }
    }
  }
}

TEST_CASE("a point at the origin bends there, and a table of two points is a straight line") {
  const Study bent = study_of(element("damper", "table = [[-1, -5], [0, 0], [1, 2]]\n"));
  const auto values = values_at(bent, 0.5);
  CHECK(force_at(bent, values, -2.0, values.element[1]) == -10.0);
  CHECK(force_at(bent, values, 2.0, values.element[1]) == 4.0);
  const Study straight = study_of(element("spring", "table = [[-1, -5], [2, 10]]\n"));
  CHECK(straight.network.elements[1].bends.empty());
  CHECK_THAT(values_at(straight, 0.5).element[1], Catch::WithinAbs(5.0, kExact));
}

TEST_CASE("a gap has a stop at each clearance that is not infinite") {
  const Study both = study_of(element("gap", "clearance = \"2*D\"\nstiffness = \"k\"\ndamping = 0.1\n"));
  const auto& bends = both.network.elements[1].bends;
  REQUIRE(bends.size() == 2);
  CHECK(bends[0].side == -1.0);
  CHECK(bends[1].side == 1.0);
  CHECK(bends[0].law == &laws::elastic_stop);
  const auto values = values_at(both, 0.7);
  for (const auto& bend : values.bends[1]) CHECK(bend == mechanics::BendValue{1.4, 3.0, 0.1});

  const Study below = study_of(element("gap", "clearance = [\"D\", inf]\nstiffness = 2\ntension = true\n"));
  REQUIRE(below.network.elements[1].bends.size() == 1);
  CHECK(below.network.elements[1].bends[0].side == -1.0);
  CHECK(below.network.elements[1].bends[0].law == &laws::spring_bend);
  CHECK(values_at(below, 0.7).bends[1].at(0) == mechanics::BendValue{0.7, 2.0, 0.0});
}

TEST_CASE("the derivative of places and slopes by a parameter agrees with differences") {
  constexpr double kStep = 1e-6, kDifference = 1e-8;
  for (const std::string& extra :
       {element("gap", "clearance = [\"D^2\", 1]\nstiffness = \"k*D\"\n"),
        element("spring", "table = [[-2, -9], [\"-D\", \"-D\"], [\"D^2\", \"D^2\"], [2, \"1/D\"]]\n")}) {
    const Study study = study_of(extra);
    mechanics::NetworkValues derivative;
    differentiate(study.values, study.parameters, study.parameters.nominal(), 1, derivative);
    const auto up = values_at(study, 0.5 + kStep), down = values_at(study, 0.5 - kStep);
    const auto check = [&](double exact, double above, double below) {
      CHECK_THAT(exact, Catch::WithinAbs((above - below) / (2.0 * kStep), kDifference));
    };
    check(derivative.element[1], up.element[1], down.element[1]);
    REQUIRE(derivative.bends[1].size() == 2);
    for (std::size_t b = 0; b < 2; ++b) {
      const auto &exact = derivative.bends[1][b], &above = up.bends[1][b], &below = down.bends[1][b];
      check(exact.place, above.place, below.place);
      check(exact.stiffness, above.stiffness, below.stiffness);
    }
  }
}

TEST_CASE("the orbits that are searched are part of a sweep's choice") {
  const std::string gap = element("gap", "clearance = 1\nstiffness = 4\n");
  const auto wanted =
      study_of(gap, "[orbits]\nstarts = 20\nmost_multiple = 2\nshow = \"smallest\"\n").orbits_wanted();
  CHECK(wanted.starts == 20);
  CHECK(wanted.most_multiple == 2);
  CHECK(wanted.show == periodic::OrbitsWanted::Show::smallest);
  CHECK(study_of(gap).orbits_wanted().show == periodic::OrbitsWanted::Show::largest);
  CHECK_FALSE(study_of(gap).sweep()->sweeps_frequency());
}

TEST_CASE("a sweep and the response it is compared with are each one of largest, smallest, up and down") {
  using enum periodic::OrbitsWanted::Show;
  const std::string gap = element("gap", "clearance = 1\nstiffness = 4\n");
  const Study study = study_of(gap, "[orbits]\nshow = \"up\"\n[compare]\nshow = \"down\"\n");
  CHECK(study.orbits_wanted().show == up);
  CHECK(study.sweep()->comparison->show == down);
  CHECK(study.sweep()->sweeps_frequency());
  const Study of_search = study_of(gap, "[orbits]\nstarts = 5\n[compare]\nshow = \"smallest\"\n");
  CHECK(of_search.sweep()->comparison->show == smallest);
  CHECK_FALSE(of_search.sweep()->sweeps_frequency());
  // The starts are those of the search beside the sweep.
  CHECK(study_of(gap, "[orbits]\nstarts = 5\nshow = \"up\"\n[compare]\nshow = \"largest\"\n")
            .orbits_wanted()
            .starts == 5);
}

}  // namespace
}  // namespace characteristic_test
