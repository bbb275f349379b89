#include "studies/provenance/fingerprint.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "studies/map/map_plan.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"

namespace fingerprint_test {
namespace {

using namespace frahm::studies;
using small_studies::axis, small_studies::oscillator;

const std::string axes = axis("f", 0, 1, 5) + axis("r", 0.1, 2, 11);
const std::string base = oscillator() + axes;

frahm::engine::Fingerprint of(const std::string& text) {
  return plan_map(parse_study(text, "small.toml"), {}).fingerprint;
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST_CASE(
    "title, comments, blanks, other ways of writing a number and nominal values of axes change nothing") {
  CHECK(of(base).physics.size() == 32);
  CHECK(of(with(base, "title = \"small\"", "title = \"other\" # new")) == of(base));
  CHECK(of(with(base, "\"2*zeta\"", "\" 2 * ( zeta ) \"")) == of(base));
  CHECK(of(with(base, "zeta = 0.05", "zeta = 5e-2")) == of(base));
  CHECK(of(with(base, "f = 0.2", "f = 0.3")) == of(base));
}

TEST_CASE("a coordinate beside an axis is part of the grid: its name and its value, not its words") {
  const std::string coordinate = "[[coordinate]]\nname = \"twice\"\nvalue = \"2*f\"\nunit = \"1\"\n";
  const auto kept = of(base + coordinate);
  CHECK(kept.grid != of(base).grid);
  CHECK(kept.physics == of(base).physics);
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"twice", "double"}, {"2*f", "3*f"}}) {
    INFO(from << " -> " << to);
    CHECK(of(with(base + coordinate, from, to)).grid != kept.grid);
    CHECK(of(with(base + coordinate, from, to)).physics == kept.physics);
  }
  CHECK(of(with(base + coordinate, "2*f", " 2 * f ")) == kept);
  CHECK(of(with(base + coordinate, "unit = \"1\"", "long_name = \"twice f\"")) == kept);
}

TEST_CASE("the order of the parameters changes nothing, that of the axes the grid") {
  const std::string orbits = "[output]\norbits = [{ f = 0, r = 0.1 }]\n";
  const std::string swapped = with(base + orbits, "f = 0.2\nzeta = 0.05\n", "zeta = 0.05\nf = 0.2\n");
  CHECK(of(swapped) == of(base + orbits));
  CHECK(of(oscillator() + axis("r", 0.1, 2, 11) + axis("f", 0, 1, 5)).grid != of(base).grid);
}

TEST_CASE("whatever changes a number changes the physics") {
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"zeta = 0.05", "zeta = 0.06"},
                                                        {"\"2*zeta\"", "\"3*zeta\""},
                                                        {"mass = 1", "mass = 1.5"},
                                                        {"force = \"f\"", "force = \"2*f\""},
                                                        {"amplitude = 1", "amplitude = 1\norder = 3"},
                                                        {"amplitude = 1", "amplitude = 1\nphase = 1"},
                                                        {"units = \"dimensionless\"", "units = \"SI\""}}) {
    INFO(from << " -> " << to);
    CHECK(of(with(base, from, to)).physics != of(base).physics);
  }
  CHECK(of(base + "[output]\nprecision = \"single\"\n").physics != of(base).physics);
  CHECK(of(base + "[output]\nquantities = \"all\"\n").physics != of(base).physics);
}

TEST_CASE("a lever's factors are physics") {
  const std::string ends = "between = [\"ground\", \"main\"]\nstiffness";
  const auto lever = of(with(base, ends, "along = { ground = -2, main = 2 }\nstiffness"));
  CHECK(lever.physics != of(base).physics);
  CHECK(of(with(base, ends, "along = { ground = -3, main = 2 }\nstiffness")).physics != lever.physics);
  CHECK(of(with(base, "mass = 1", "inertia = 1")).physics != of(base).physics);
}

TEST_CASE("other values on an axis are another grid of the same physics") {
  const std::string finer = oscillator() + axis("f", 0, 1, 6) + axis("r", 0.1, 2, 11);
  CHECK(of(finer).physics == of(base).physics);
  CHECK(of(finer).grid != of(base).grid);
  const std::string turned = oscillator() + axis("r", 0.1, 2, 11) + axis("f", 0, 1, 5);
  CHECK(of(turned).grid != of(base).grid);
}

TEST_CASE("a default that is written out and the unit of a value change nothing") {
  const std::string si = with(base, "dimensionless", "SI");
  CHECK(of(base + "spacing = \"linear\"\n[output]\nprecision = \"double\"\n") == of(base));
  CHECK(of(with(si, "mass = 1", "mass = { value = 1000, unit = \"g\" }")) == of(si));
  CHECK(of(with(si, "zeta = 0.05", "zeta = { value = 50, unit = \"g/s\" }")) == of(si));
}

TEST_CASE("a table without a key of its own says that it is there") {
  const std::string output = base + "[output]\n";
  CHECK(of(output) == of(base));
  CHECK(of(output + "branches = {}\n").grid != of(base).grid);
  CHECK(of(output + "branches = {}\n") == of(output + "branches = true\n"));
}

TEST_CASE("a unit that other numbers inherit is part of what they say") {
  // The axis stays the same in SI, and the parameter's own value is none of the map's; of 0.1 in the unit of
  // the axis there is another point.
  const auto axis_in = [](const std::string& unit, const std::string& range) {
    return with(oscillator(), "dimensionless", "SI") + axis("r", 0.1, 2, 11) +
           "[[axis]]\nparameter = \"f\"\nunit = \"" + unit + "\"\n" + range + "points = 5\n";
  };
  const std::string in_newton = axis_in("N", "from = 0\nto = 1000\n"),
                    in_kilonewton = axis_in("kN", "from = 0\nto = 1\n"),
                    orbit = "[output]\norbits = [{ f = 1, r = 0.1 }]\n";
  CHECK(of(in_newton) == of(in_kilonewton));
  CHECK(of(in_newton + orbit).grid != of(in_kilonewton + orbit).grid);
}

TEST_CASE("the contents of a table are part of the physics") {
  const auto path = std::filesystem::temp_directory_path() / "frahm-fingerprint-table.csv";
  const std::string text =
      with(base, "zeta = 0.05", "zeta = { table = \"" + path.string() + "\", of = \"f\" }");
  const auto write = [&](const char* rows) { std::ofstream(path) << rows; };
  write("0,0.1\n1,0.2\n");
  const auto before = of(text);
  write("0.0, 0.10\n1, 0.2\n");
  CHECK(of(text) == before);
  write("0,0.1\n1,0.3\n");
  CHECK(of(text).physics != before.physics);
  std::filesystem::remove(path);
}

TEST_CASE("a comparison, its slope and its quantities are part of the physics") {
  const std::string compare = "[compare]\nlaw = \"arctan\"\nslope = 1e3\n";
  CHECK(of(base + compare).physics != of(base).physics);
  CHECK(of(base + with(compare, "1e3", "1e4")).physics != of(base + compare).physics);
  CHECK(of(base + compare + "quantities = [\"main_rms\"]\n").physics != of(base + compare).physics);
}

}  // namespace
}  // namespace fingerprint_test
