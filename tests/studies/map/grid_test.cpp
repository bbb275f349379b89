#include "studies/map/grid.hpp"

#include <catch2/catch.hpp>
#include <numeric>

#include "studies/map/map_plan.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"
#include "tests/study_path.hpp"

namespace grid_test {
namespace {

using namespace frahm::studies;
using small_studies::axis, small_studies::oscillator;

Study study_of(const std::string& axes) {
  return parse_study(oscillator() + axes, "small.toml");
}

// How often each point of the map lies in a tile.
std::vector<int> visits(const Grid& grid) {
  std::vector<int> visited(grid.points());
  std::vector<std::size_t> dimensions(grid.shape.size());
  std::iota(dimensions.begin(), dimensions.end(), 0);
  for (std::uint64_t tile = 0; tile < grid.tiles(); ++tile) {
    const MapBox box = grid.box(tile);
    std::vector<std::uint64_t> index = box.start;
    do {
      std::uint64_t offset = 0;
      for (std::size_t d = 0; d < index.size(); ++d) offset = offset * grid.shape[d] + index[d];
      ++visited.at(offset);
    } while (next_point(box, dimensions, index));
  }
  return visited;
}

// Chunks hold tile after tile, each in one chunk.
void check_tiles_of_chunks(const Grid& grid) {
  std::uint64_t next = 0;  // the tile to come
  for (std::uint64_t chunk = 0; chunk < grid.chunks(); ++chunk) {
    const MapBox box = grid.chunk_box(chunk);
    CHECK(grid.tile_of(box.start) == next);
    for (std::uint64_t points = 0; points < box.points(); ++next) {
      const MapBox tile = grid.box(next);
      CHECK(grid.tile_of(tile.start) == next);
      for (std::size_t d = 0; d < tile.start.size(); ++d) {
        REQUIRE(tile.start[d] >= box.start[d]);
        REQUIRE(tile.start[d] + tile.count[d] <= box.start[d] + box.count[d]);
      }
      points += tile.points();
    }
  }
  CHECK(next == grid.tiles());
}

void check_chunks(const Grid& grid) {
  check_tiles_of_chunks(grid);
  for (std::size_t d = 0; d < grid.shape.size(); ++d) {
    INFO("dimension " << d << ": chunk " << grid.chunk[d] << ", tile " << grid.tile[d]);
    CHECK((grid.chunk[d] % grid.tile[d] == 0 || grid.chunk[d] == grid.shape[d]));
  }
}

TEST_CASE("the tiles of a map hold each of its points once, and its chunks are unions of tiles") {
  for (const std::string& axes :
       {axis("r", 0.1, 2, 7), axis("r", 0.1, 2, 9001), axis("f", 0, 1, 31) + axis("r", 0.1, 2, 401),
        axis("r", 0.1, 2, 401) + axis("f", 0, 1, 31), axis("f", 0, 1, 5) + axis("zeta", 0, 1, 600),
        axis("zeta", 0, 1, 3) + axis("r", 0.1, 2, 5) + axis("f", 0, 1, 700),
        axis("zeta", 0, 1, 53) + axis("r", 0.1, 2, 301) + axis("f", 0, 1, 41)}) {
    INFO(axes);
    const Grid grid = grid_of(study_of(axes));
    const std::vector<int> visited = visits(grid);
    CHECK(std::count(visited.begin(), visited.end(), 1) == static_cast<std::ptrdiff_t>(visited.size()));
    check_chunks(grid);
  }
}

TEST_CASE("the rig atlas is cut into tiles of whole frequency rows, and chunks of 128 KiB and more") {
  const Grid grid = grid_of(read_study(study_path("rig_atlas")));
  CHECK(grid.points() == 522102);
  CHECK(grid.tile == std::vector<std::uint64_t>{1, 4, 401});
  CHECK(grid.tiles() == 42 * 8);
  CHECK(grid.chunk == std::vector<std::uint64_t>{2, 31, 401});
  CHECK(grid.order == std::vector<std::size_t>{0, 1, 2});
}

TEST_CASE("the frequency runs innermost wherever it stands in the study") {
  const Grid grid = grid_of(study_of(axis("r", 0.1, 2, 401) + axis("f", 0, 1, 31)));
  CHECK(grid.order == std::vector<std::size_t>{1, 0});
  CHECK(grid.tile[0] == 401);
}

TEST_CASE("a row of frequencies longer than 4000 is cut") {
  const Grid grid = grid_of(study_of(axis("f", 0, 1, 2) + axis("r", 0.1, 2, 10000)));
  CHECK(grid.tile == std::vector<std::uint64_t>{1, 2500});
  CHECK(grid.tiles() == 8);
}

TEST_CASE("a point is told as the option --at takes it, with its units") {
  const Study rig = read_study(study_path("rig_atlas"));
  CHECK(point_text(rig, std::vector<std::uint64_t>{41, 1, 400}) == "I=12.9 kg,FP=0.01,omega=350 rpm");
}

TEST_CASE("a coordinate that is a parameter alone is converted to its unit, an expression is in it") {
  std::string metric = oscillator();
  const std::string units = "units = \"dimensionless\"\n";
  metric.erase(metric.find(units), units.size());
  const Study study =
      parse_study(metric + small_studies::axis_of("f", "[100, 250]") +
                      "[[coordinate]]\nname = \"force\"\nvalue = \"f\"\nunit = \"kN\"\n"
                      "[[coordinate]]\nname = \"double\"\nvalue = \"2*f/1000\"\nunit = \"kN\"\n",
                  "small.toml");
  CHECK(coordinate_values(study, study.map()->coordinates[0]) == std::vector<double>{0.1, 0.25});
  CHECK(coordinate_values(study, study.map()->coordinates[1]) == std::vector<double>{0.2, 0.5});
}

TEST_CASE("a map that meets the arctan law is cut into small tiles, as its points take long") {
  const Study study =
      parse_study(small_studies::oscillator() + small_studies::axis("f", 0, 1, 10) +
                      small_studies::axis("r", 0.5, 1.5, 41) + "[compare]\nlaw = \"arctan\"\nslope = 1e3\n",
                  "small.toml");
  const Grid grid = grid_of(study);
  CHECK(grid.tile == std::vector<std::uint64_t>{1, 7});
  CHECK(grid.tiles() == 10 * 6);
}

TEST_CASE("a row along which the frequency is swept is in one tile, however long or dear") {
  std::string stops = small_studies::oscillator();
  stops +=
      "[[element]]\nname = \"stops\"\ntype = \"gap\"\nbetween = [\"ground\", \"main\"]\n"
      "clearance = 1\nstiffness = 4\n";
  const std::string axes = axis("f", 0, 1, 5) + axis("r", 0.1, 2, 5000);
  const auto points_of_tile = [&](const std::string& more) {
    return grid_of(parse_study(stops + axes + more, "stops.toml")).tile;
  };
  CHECK(points_of_tile("").back() < 500);
  CHECK(points_of_tile("[orbits]\nshow = \"up\"\n") == std::vector<std::uint64_t>{1, 5000});
  CHECK(points_of_tile("[compare]\nshow = \"down\"\n") == std::vector<std::uint64_t>{1, 5000});
}

TEST_CASE("a row of a building's frequencies is cut, so that every core has some of it") {
  const auto points_of_tile = [](int storeys) {
    const Grid grid = grid_of(parse_study(small_studies::building(storeys, 3, 200), "building.toml"));
    CHECK(grid.points() == 200);
    return grid.tile[0];
  };
  CHECK(points_of_tile(2) == 200);
  CHECK(points_of_tile(30) <= 100);
  CHECK(points_of_tile(40) <= 25);
  CHECK(points_of_tile(60) <= 10);
}

TEST_CASE("A map of more tiles than can be kept track of is refused at once") {
  const auto plan = [](int frequencies) {
    return plan_map(study_of(axis("f", 0.1, 0.3, 1000000) + axis("r", 0.5, 1.5, frequencies)), {});
  };
  CHECK(plan(60000).tiles == 15'000'000);
  CHECK_THROWS_WITH(
      plan(1000000),
      Catch::Contains(
          "the map of 1000000000000 points has 250000000 tiles, but at most 16777216 can be tracked"));
}

}  // namespace
}  // namespace grid_test
