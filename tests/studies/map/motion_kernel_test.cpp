#include "studies/map/motion_kernel.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "studies/motion/one_motion.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"

namespace motion_kernel_test {
namespace {

using namespace frahm::studies;
using small_studies::axis_of;

// The oscillator of the small studies, thrown and shaken for twenty radians.
std::string thrown(const std::string& more) {
  std::string text = small_studies::oscillator("\"k\"");
  text.replace(text.find("\"sweep\""), 7, "\"transient\"");
  return text + "[transient]\nduration = 20\n[[initial]]\nnode = \"main\"\nvelocity = 1\n" + more;
}

const std::string full = "[output]\nprecision = \"full\"\n";

MapPlan plan_of(const std::string& text) {
  return plan_map(parse_study(text, "small.toml"), {});
}

TileEntry tile_of(const MapPlan& plan, std::uint64_t number) {
  MotionKernel kernel(plan, {});
  frahm::engine::Bytes bytes;
  kernel(number, bytes);
  TileEntry entry;
  decode(bytes, plan.grid.box(number).points() * plan.variables.size(), entry);
  return entry;
}

TEST_CASE("each point of a map of motions is the motion that its study tells alone, to the last digit") {
  const MapPlan plan =
      plan_of(thrown(axis_of("f", "[0, 0.3, 1.5]") + axis_of("r", "[0.7, 1.1]") + full +
                     "quantities = [\"main_peak\", \"main_peak_time\", \"friction_energy\"]\n"));
  for (std::uint64_t tile = 0; tile < plan.grid.tiles(); ++tile) {
    const MapBox box = plan.grid.box(tile);
    const TileEntry entry = tile_of(plan, tile);
    std::vector<std::uint64_t> index = box.start;
    do {
      const std::string at = point_text(plan.study, index);
      INFO(at);
      const double f[] = {0.0, 0.3, 1.5}, r[] = {0.7, 1.1};
      Study alone = parse_study(thrown(""), "small.toml");
      alone = with_parameters(alone, std::vector<Assignment>{{*alone.parameters.find("f"), f[index[0]]},
                                                             {*alone.parameters.find("r"), r[index[1]]}});
      const auto motion = solve_transient(alone);
      const std::uint64_t place = box.offset_of(index), points = box.points();
      CHECK(entry.values[place] == std::abs(motion.peaks[0].displacement));
      CHECK(entry.values[points + place] == motion.peaks[0].time);
      CHECK(entry.values[2 * points + place] == motion.energy.dissipated[2]);
    } while (next_point(box, plan.grid.order, index));
  }
}

TEST_CASE("a motion whose values break a rule of mechanics is a point that fails with the reason") {
  const MapPlan plan = plan_of(thrown(axis_of("k", "[1, -1, 2]") +
                                      "[output]\nquantities = [\"main_peak\", \"friction_slips\", "
                                      "\"status\"]\n"));
  REQUIRE(plan.grid.tiles() == 1);
  const TileEntry tile = tile_of(plan, 0);
  REQUIRE(tile.failed.size() == 1);
  CHECK(tile.failed[0].offset == 1);
  CHECK_THAT(tile.failed[0].reason, Catch::Contains("stiffness"));
  CHECK(std::isnan(tile.values[1]));
  CHECK(tile.values[3 + 1] == -1.0);
  CHECK(tile.values[6 + 1] == 4.0);
  CHECK(tile.values[6 + 0] == 1.0);
}

// A sledge is pushed over a plate that lies on the ground; both contacts have a static limit. Who slides is
// an event of two contacts at once, and a wrong choice is one whose energies do not balance.
const std::string sledge_on_plate =
    "[study]\nschema = 1\nkind = \"transient\"\n[parameters]\nP = 17\n"
    "[[mass]]\nname = \"sledge\"\nmass = 1\n[[mass]]\nname = \"plate\"\nmass = 1\n"
    "[[element]]\nname = \"k1\"\ntype = \"spring\"\nbetween = [\"ground\", \"sledge\"]\nstiffness = 1e-6\n"
    "[[element]]\nname = \"k2\"\ntype = \"spring\"\nbetween = [\"ground\", \"plate\"]\nstiffness = 1e-6\n"
    "[[element]]\nname = \"f1\"\ntype = \"coulomb\"\nbetween = [\"plate\", \"sledge\"]\nforce = 5\n"
    "static_force = 11\n"
    "[[element]]\nname = \"f2\"\ntype = \"coulomb\"\nbetween = [\"ground\", \"plate\"]\nforce = 2\n"
    "static_force = 2.4\n"
    "[[excitation.force]]\non = \"sledge\"\namplitude = \"P\"\norder = 0\n"
    "[[excitation.force]]\non = \"plate\"\namplitude = -6.6\norder = 0\n"
    "[transient]\nduration = 0.1\n";

TEST_CASE("how a motion ended does not depend on what is asked of it") {
  const std::string map = sledge_on_plate + axis_of("P", "[15, 16, 17, 18]") + full + "quantities = ";
  const auto statuses = [&](const std::string& quantities) {
    const MapPlan plan = plan_of(map + quantities + "\n");
    const auto status =
        std::ranges::find(plan.variables, "status", &frahm::periodic::QuantityDescription::name);
    REQUIRE(status != plan.variables.end());
    std::vector<double> found;
    for (std::uint64_t tile = 0; tile < plan.grid.tiles(); ++tile) {
      const std::vector<double> values = tile_of(plan, tile).values;
      const auto points = static_cast<std::ptrdiff_t>(plan.grid.box(tile).points());
      const auto first = values.begin() + points * (status - plan.variables.begin());
      found.insert(found.end(), first, first + points);
    }
    return found;
  };
  const std::vector<double> all = statuses("\"all\"");
  for (const auto& variable : plan_of(map + "\"all\"\n").variables) {
    INFO(variable.name);
    CHECK(statuses("[\"" + variable.name + "\"]") == all);
  }
}

TEST_CASE("a stop is obeyed within a motion") {
  const MapPlan plan = plan_of(thrown(axis_of("f", "[0, 0.3]")));
  MotionKernel kernel(plan, [] { return true; });
  frahm::engine::Bytes bytes;
  CHECK_THROWS_AS(kernel(0, bytes), frahm::engine::GivenUp);
}

TEST_CASE("the duration of its motions is part of a map's physics, their samples are not") {
  const std::string text = thrown(axis_of("f", "[0, 0.3]"));
  const auto with = [&](const std::string& line) {
    std::string changed = text;
    changed.replace(changed.find("duration = 20"), 13, line);
    return plan_of(changed).fingerprint;
  };
  CHECK(with("duration = 20\nsamples = 11").physics == with("duration = 20").physics);
  CHECK(with("duration = 21").physics != with("duration = 20").physics);
}

TEST_CASE("a map of few motions has a tile for each thread, one of many cheap motions none for each point") {
  const auto tiles = [&](int points, const char* duration) {
    std::string text = thrown(small_studies::axis("f", 0, 0.4, points));
    text.replace(text.find("duration = 20"), 13, duration);
    return plan_of(text).grid.tiles();
  };
  CHECK(tiles(21, "duration = 20000") == 21);
  CHECK(tiles(100'000, "duration = 20") < 10'000);
}

}  // namespace
}  // namespace motion_kernel_test
