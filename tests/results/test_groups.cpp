#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "results/map_reader.hpp"
#include "results/map_writer.hpp"
#include "sample.hpp"
#include "temporary_directory.hpp"

namespace test_groups {
using namespace frahm::results;

namespace {

const Column& named(const std::vector<Column>& columns, const std::string& name) {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const Column& column) { return column.variable.name == name; });
  if (found == columns.end()) throw std::runtime_error("no column " + name);
  return *found;
}

}  // namespace

TEST_CASE("texts of any length and script come back in their order") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const MapReader reader(directory / "map.h5");
  const std::vector<Text> expected = {
      {"study", sample::study_text()}, {"version", "0.1.0"}, {"note", "Dämpfung ζ"}, {"empty", ""}};
  CHECK(reader.texts("provenance") == expected);
}

TEST_CASE("the samples of each row of a ragged group are where row_start says") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const MapReader reader(directory / "map.h5");
  const std::vector<Column> orbits = reader.columns("orbits");
  CHECK(named(orbits, "row_start").values == std::vector<double>{0, 0, 3000});
  CHECK(named(orbits, "row_start").dimension == "orbit");
  CHECK(named(orbits, "omega").values == std::vector<double>{100, 101, 102});
  const Column& displacement = named(orbits, "main_displacement");
  CHECK(displacement.dimension == "sample");
  CHECK(displacement.variable.unit == "m");
  REQUIRE(displacement.values.size() == 9000);
  CHECK(displacement.values[2999] == std::ldexp(2999.0, -10));
  CHECK(displacement.values[3000] == 0.0);
  CHECK(displacement.values[8999] == std::ldexp(5999.0, -10));
}

TEST_CASE("a ragged group without samples is a table, and may be empty") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const MapReader reader(directory / "map.h5");
  CHECK(reader.columns("borders").size() == 1);
  CHECK(named(reader.columns("borders"), "omega").values == std::vector<double>{160.5, 161.5, 162.5});
  CHECK(named(reader.columns("no_borders"), "omega").values.empty());
}

TEST_CASE("numbers and columns of a group come back with their dimensions") {
  const TemporaryDirectory directory;
  sample::write(directory / "map.h5");
  const MapReader reader(directory / "map.h5");
  const std::vector<Column> optimum = reader.columns("optimum");
  CHECK(optimum.size() == 5);
  CHECK(named(optimum, "objective").values == std::vector<double>{0.0125});
  CHECK(named(optimum, "objective").dimension.empty());
  CHECK(named(optimum, "iterations").variable.type == Type::int32);
  CHECK(named(optimum, "knot").dimension == "knot");
  CHECK(named(optimum, "knot").values == std::vector<double>{15, 25, 35});
  CHECK(named(optimum, "inertance").dimension == "knot");
  CHECK(std::isnan(named(optimum, "inertance").values.at(1)));
  CHECK(named(optimum, "active").dimension == "peak");
  CHECK(named(optimum, "active").values.empty());
}

TEST_CASE("a group may have texts beside its numbers") {
  const TemporaryDirectory directory;
  {
    MapWriter writer(directory / "map.h5", {});
    writer.write_columns(
        "optimum", {{.variable = {.name = "objective", .unit = "m", .long_name = "peak"}, .values = {1.0}}});
    writer.write_texts("optimum", {{"stopped", "the certificate gap is below its tolerance"}});
    writer.finish();
  }
  const MapReader reader(directory / "map.h5");
  CHECK(reader.has_group("optimum"));
  CHECK_FALSE(reader.has_group("orbits"));
  CHECK(reader.columns("optimum").size() == 1);
  CHECK(reader.texts("optimum") ==
        std::vector<Text>{{"stopped", "the certificate gap is below its tolerance"}});
}
}  // namespace test_groups
