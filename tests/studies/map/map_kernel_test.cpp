#include "studies/map/map_kernel.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/orbits/closed_forms.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"

namespace map_kernel_test {
namespace {

using namespace frahm::studies;
using small_studies::axis, small_studies::axis_of, small_studies::oscillator;

constexpr double closed_form_tolerance = 1e-9;  // of amplitudes of order 1, where the solver stops at 1e-12

const std::string peaks = "[output]\nquantities = [\"main_peak\", \"status\", \"friction_stops\"]\n";

MapPlan plan_of(const std::string& text) {
  return plan_map(parse_study(text, "small.toml"), {});
}

frahm::engine::Bytes bytes_of(MapKernel& kernel, std::uint64_t tile) {
  frahm::engine::Bytes bytes;
  kernel(tile, bytes);
  return bytes;
}

TileEntry tile_of(const MapPlan& plan, std::uint64_t tile) {
  MapKernel kernel(plan.study, plan.grid, plan.quantities);
  TileEntry entry;
  decode(bytes_of(kernel, tile), plan.grid.box(tile).points() * plan.variables.size(), entry);
  return entry;
}

TEST_CASE("a tile holds the responses of its points in the map's order") {
  const MapPlan plan = plan_of(oscillator() + axis("f", 0, 0.4, 3) + axis("r", 0.8, 1.2, 5) + peaks);
  REQUIRE(plan.grid.tiles() == 1);
  const TileEntry tile = tile_of(plan, 0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 5; ++j) {
      INFO("point " << i << ", " << j);
      const double expected = frahm::periodic::non_stop_response(0.8 + 0.1 * j, 0.05, 0.2 * i).amplitude;
      CHECK_THAT(tile.values[5 * i + j], Catch::WithinAbs(expected, closed_form_tolerance));
      CHECK(tile.values[15 + 5 * i + j] == 1.0);
      CHECK(tile.values[30 + 5 * i + j] == 0.0);
    }
  }
}

TEST_CASE("the place of the frequency among the axes does not change the responses") {
  const TileEntry last =
      tile_of(plan_of(oscillator() + axis("f", 0, 1, 7) + axis("r", 0.3, 1.2, 9) + peaks), 0);
  const TileEntry first =
      tile_of(plan_of(oscillator() + axis("r", 0.3, 1.2, 9) + axis("f", 0, 1, 7) + peaks), 0);
  for (std::size_t q = 0; q < 3; ++q) {
    for (std::size_t i = 0; i < 7; ++i) {
      for (std::size_t j = 0; j < 9; ++j)
        CHECK(last.values[63 * q + 9 * i + j] == first.values[63 * q + 7 * j + i]);
    }
  }
}

TEST_CASE("the bytes of a tile do not depend on the tiles computed before it") {
  const MapPlan plan = plan_of(oscillator() + axis("f", 0, 1, 40) + axis("r", 0.2, 1.2, 150));
  REQUIRE(plan.grid.tiles() > 5);
  MapKernel busy(plan.study, plan.grid, plan.quantities), fresh(plan.study, plan.grid, plan.quantities);
  for (const std::uint64_t tile : {3, 1, 4}) bytes_of(busy, tile);
  CHECK(bytes_of(busy, 2) == bytes_of(fresh, 2));
}

TEST_CASE(
    "a point whose values break a rule of mechanics fails with the reason, and the others are computed") {
  const MapPlan plan =
      plan_of(oscillator("\"k\"") + axis_of("k", "[1, -1, 2]") + axis_of("r", "[0.5, 0.6]") + peaks);
  const TileEntry tile = tile_of(plan, 0);
  REQUIRE(tile.failed.size() == 2);
  CHECK(tile.failed[0].offset == 2);
  CHECK_THAT(tile.failed[0].reason, Catch::Contains("stiffness") && Catch::Contains("not positive definite"));
  CHECK(std::isnan(tile.values[2]));
  CHECK(tile.values[6 + 2] == 4.0);    // failed
  CHECK(tile.values[12 + 2] == -1.0);  // no count
  for (const std::size_t place : {0, 1, 4, 5}) CHECK(tile.values[6 + place] == 1.0);
}

TEST_CASE("a map without a frequency axis is computed, also where stiffness and damping change") {
  const MapPlan plan = plan_of(oscillator("\"k\"") + axis("k", 1, 2, 3) + axis("zeta", 0.1, 0.5, 3) + peaks);
  const TileEntry tile = tile_of(plan, 0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      // In units of the stiffness k: r / sqrt k, c / (2 sqrt k), f, x k.
      const double k = 1 + 0.5 * i, zeta = 0.1 + 0.2 * j;
      const double expected =
          frahm::periodic::classical_amplitude(0.9 / std::sqrt(k), zeta / std::sqrt(k), 0.2) / k;
      CHECK_THAT(tile.values[3 * i + j], Catch::WithinAbs(expected, closed_form_tolerance));
    }
  }
}

TEST_CASE("frequencies that stand still or turn back along a zip are computed like any others") {
  const std::string zip = "zip = \"path\"\n";
  const MapPlan plan = plan_of(oscillator() + axis_of("r", "[0.7, 0.8, 0.8, 0.7, 0.7, 1.3]", zip) +
                               axis_of("f", "[0.1, 0.1, 0.2, 0.2, 0.1, 0.1]", zip) + peaks);
  const TileEntry tile = tile_of(plan, 0);
  const double r[] = {0.7, 0.8, 0.8, 0.7, 0.7, 1.3}, f[] = {0.1, 0.1, 0.2, 0.2, 0.1, 0.1};
  for (int i = 0; i < 6; ++i) {
    const double expected = frahm::periodic::non_stop_response(r[i], 0.05, f[i]).amplitude;
    CHECK_THAT(tile.values[i], Catch::WithinAbs(expected, closed_form_tolerance));
  }
}

const std::string compare_laws = "[compare]\nlaw = \"arctan\"\nslope = 1e3\n";

// The kernel's values of a variable of a plan.
std::vector<double> values_of(const MapPlan& plan, const TileEntry& tile, const std::string& name) {
  const std::size_t points = tile.values.size() / plan.variables.size();
  for (std::size_t v = 0; v < plan.variables.size(); ++v) {
    if (plan.variables[v].name != name) continue;
    const auto first = tile.values.begin() + static_cast<std::ptrdiff_t>(v * points);
    return {first, first + static_cast<std::ptrdiff_t>(points)};
  }
  throw std::invalid_argument(name);
}

TEST_CASE("what is compared is what a study of the other law has itself") {
  const std::string axes = axis("f", 0.1, 0.4, 3) + axis("r", 0.8, 1.2, 4);
  const std::string every_bit =  // every bit, of which the difference is taken
      "[output]\nquantities = [\"main_peak\", \"status\", \"friction_stops\"]\nprecision = \"full\"\n";
  const MapPlan both = plan_of(oscillator() + axes + every_bit + compare_laws);
  std::string text = oscillator();
  text.insert(text.find("force = \"f\""), "law = \"arctan\"\nslope = 1e3\n");
  const MapPlan other = plan_of(text + axes + every_bit);
  const TileEntry tile = tile_of(both, 0), alone = tile_of(other, 0);
  CHECK(values_of(both, tile, "main_peak_compared") == values_of(other, alone, "main_peak"));
  CHECK(values_of(both, tile, "status_compared") == std::vector<double>(12, 1.0));
  const auto own = values_of(both, tile, "main_peak"), compared = values_of(both, tile, "main_peak_compared");
  const auto difference = values_of(both, tile, "main_peak_difference");
  for (std::size_t i = 0; i < own.size(); ++i)
    CHECK(difference[i] == std::abs(own[i] - compared[i]) / own[i]);
}

TEST_CASE("a mean of nothing but rounding has no relative difference") {
  const MapPlan plan = plan_of(oscillator() + axis("r", 0.8, 1.2, 3) + peaks + compare_laws +
                               "quantities = [\"main_mean\", \"main_rms\"]\n");
  const TileEntry tile = tile_of(plan, 0);
  for (const double difference : values_of(plan, tile, "main_mean_difference")) CHECK(std::isnan(difference));
  for (const double difference : values_of(plan, tile, "main_rms_difference")) CHECK(difference < 0.1);
}

TEST_CASE("a quantity can be compared that the study does not record itself") {
  const MapPlan plan = plan_of(oscillator() + axis("r", 0.8, 1.2, 2) + peaks + compare_laws +
                               "quantities = [\"main_rms\", \"main_peak\"]\n");
  const TileEntry tile = tile_of(plan, 0);
  REQUIRE(plan.variables.size() == 8);
  CHECK(plan.variables[3].name == "main_rms_compared");
  for (const double difference : values_of(plan, tile, "main_rms_difference")) CHECK(difference < 1e-3);
}

TEST_CASE("a slope may run along an axis") {
  const MapPlan plan = plan_of(oscillator() + axis_of("k", "[1e2, 1e3, 1e4]") + axis_of("r", "[0.9, 1.2]") +
                               peaks + "[compare]\nlaw = \"arctan\"\nslope = \"k\"\n");
  const auto difference = values_of(plan, tile_of(plan, 0), "main_peak_difference");
  CHECK(difference[2] < 0.3 * difference[0]);
  CHECK(difference[5] < 0.3 * difference[3]);
}

TEST_CASE("cranks cut at another order are compared too") {
  const auto crank = [](const std::string& cut) {
    std::string text = oscillator();
    const auto force = text.find("[[excitation.force]]");
    text.replace(force, std::string::npos,
                 "[[excitation.motion]]\nnode = \"base\"\nprofile = \"crank\"\ncrank = 1\nrod = 4\n" + cut);
    return text.replace(text.find("[\"ground\", \"main\"]"), 18, "[\"base\", \"main\"]");
  };
  const std::string axes = axis("f", 0.1, 0.3, 2) + axis("r", 0.8, 1.2, 3);
  const MapPlan both = plan_of(crank("") + axes + peaks + "[compare]\ntaylor_order = 1\n");
  const MapPlan other = plan_of(crank("taylor_order = 1\n") + axes + peaks);
  const auto compared = values_of(both, tile_of(both, 0), "main_peak_compared");
  CHECK(compared == values_of(other, tile_of(other, 0), "main_peak"));
  for (const double difference : values_of(both, tile_of(both, 0), "main_peak_difference")) {
    CHECK(difference > 1e-3);
    CHECK(difference < 0.3);
  }
}

TEST_CASE("where only the compared law finds no orbit the point tells why and keeps its own values") {
  // Damped so weakly that integration is not accurate enough for the orbit.
  std::string text = oscillator();
  text.replace(text.find("zeta = 0.05"), 11, "zeta = 1e-7");
  const MapPlan plan = plan_of(text + axis_of("f", "[0, 0.9]") + axis_of("r", "[1]") + peaks + compare_laws);
  const TileEntry tile = tile_of(plan, 0);
  REQUIRE(tile.failed.size() == 1);
  CHECK(tile.failed[0].offset == 0);
  CHECK_THAT(tile.failed[0].reason, Catch::StartsWith("compared: ") && Catch::Contains("estimated error"));
  CHECK(values_of(plan, tile, "status")[0] == 1.0);
  CHECK_THAT(values_of(plan, tile, "main_peak")[0], Catch::WithinRel(5e6, 1e-6));
  CHECK(values_of(plan, tile, "status_compared")[0] == 4.0);
  CHECK(std::isnan(values_of(plan, tile, "main_peak_compared")[0]));
  CHECK(std::isnan(values_of(plan, tile, "main_peak_difference")[0]));
}

TEST_CASE("the bytes of a tile with a comparison do not depend on what its kernel did before") {
  const MapPlan plan =
      plan_of(oscillator() + axis("f", 0.1, 1, 3) + axis("r", 0.5, 1.2, 4) + peaks + compare_laws);
  MapKernel busy(plan.study, plan.grid, plan.quantities), fresh(plan.study, plan.grid, plan.quantities);
  bytes_of(busy, 0);
  CHECK(bytes_of(busy, 0) == bytes_of(fresh, 0));
}

}  // namespace
}  // namespace map_kernel_test
