// [output] borders: where the regimes change, in the group /borders.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "results/map_reader.hpp"
#include "solvers/orbits/closed_forms.hpp"
#include "tests/end_to_end/grown_maps.hpp"
#include "tests/end_to_end/runs.hpp"
#include "tests/studies/small_studies.hpp"

namespace borders_test {
namespace {

using frahm::periodic::critical_friction;
using runs::Folder, runs::Map, runs::read_map;
using small_studies::axis, small_studies::axis_of, small_studies::oscillator;

constexpr double place_tolerance = 1e-7;  // of an edge: half as much is the search's, the rest is rounding
constexpr double non_stop = 2, stuck = 5;

const std::string with_borders = "[output]\nborders = true\nquantities = [\"main_peak\"]\n";

// The columns of /borders.
struct Borders {
  std::map<std::string, std::vector<double>> columns;

  explicit Borders(const std::string& path) {
    for (const auto& column : frahm::results::MapReader(path).columns("borders"))
      columns[column.variable.name] = column.values;
  }
  const std::vector<double>& operator[](const std::string& name) const { return columns.at(name); }
  std::size_t size() const { return columns.at("axis").size(); }
  friend bool operator==(const Borders&, const Borders&) = default;
};

Borders borders_of(const std::string& study) {
  const Folder folder;
  const auto outcome = grown_maps::run(folder.write("map.toml", study), folder / "map.h5");
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  return Borders(folder / "map.h5");
}

// Whether f - f_crit changes its sign within `r_by`, `f_by` of a place.
bool lies_on_critical_friction(double r, double f, double zeta, double r_by, double f_by) {
  const auto excess = [&](double sign) { return f + sign * f_by - critical_friction(r + sign * r_by, zeta); };
  return excess(-1.0) * excess(1.0) <= 0.0;
}

TEST_CASE("the border of the motion without stops is Den Hartog's f_crit along friction, for all r") {
  const double step = 0.07;
  const Borders found = borders_of(oscillator() + axis("f", 0.006, 0.006 + 15 * step, 16) +
                                   axis("r", 0.11, 1.91, 31) + with_borders);
  int along_f = 0, along_r = 0, at_low_r = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found["regime_below"][i] != non_stop && found["regime_above"][i] != non_stop) continue;
    const double r = found["r"][i], f = found["f"][i];
    INFO("r = " << r << ", f = " << f);
    if (found["axis"][i] == 1) {
      ++along_f;
      at_low_r += r < 0.5;
      CHECK_THAT(f, Catch::WithinAbs(critical_friction(r, 0.05), place_tolerance * step));
    } else {
      ++along_r;
      CHECK(lies_on_critical_friction(r, f, 0.05, place_tolerance * 0.06, 0.0));
    }
  }
  long expected = 0;
  for (int k = 0; k < 31; ++k) expected += critical_friction(0.11 + 0.06 * k, 0.05) > 0.006;
  CHECK(along_f == expected);
  CHECK(at_low_r > 4);
  CHECK(along_r > 10);
}

TEST_CASE("the mass sticks for good from F = P on, for all r") {
  const Borders found =
      borders_of(oscillator() + axis("f", 0.36, 1.06, 5) + axis("r", 0.3, 1.9, 17) + with_borders);
  int borders = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found["regime_above"][i] != stuck) continue;
    ++borders;
    CHECK_THAT(found["f"][i], Catch::WithinAbs(1.0, place_tolerance * 0.175));
    CHECK(found["axis"][i] == 1);
  }
  CHECK(borders == 17);
}

TEST_CASE("on grid points that lie on a border it is found once from either side") {
  const Borders found =
      borders_of(oscillator() + axis_of("f", "[0.8, 0.9, 1, 1.1]") + axis("r", 0.3, 1.9, 401) + with_borders);
  CHECK(std::ranges::count(found["regime_above"], stuck) == 401);
}

TEST_CASE("along axes that advance together the border is met on the line between their points") {
  const std::string zip = "zip = \"path\"\n";
  const Borders found = borders_of(oscillator() + axis_of("f", "[0.1, 0.35, 0.9]", zip) +
                                   axis_of("r", "[0.5, 0.7, 1.3]", zip) + with_borders);
  REQUIRE(found.size() > 0);
  bool any = false;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double f = found["f"][i], r = found["r"][i], t = f < 0.35 ? (f - 0.1) / 0.25 : (f - 0.35) / 0.55;
    CHECK_THAT(r, Catch::WithinAbs(f < 0.35 ? 0.5 + 0.2 * t : 0.7 + 0.6 * t, 1e-12));
    if (found["regime_below"][i] != non_stop && found["regime_above"][i] != non_stop) continue;
    any = true;
    CHECK(lies_on_critical_friction(r, f, 0.05, place_tolerance * 0.6, place_tolerance * 0.55));
  }
  CHECK(any);
}

TEST_CASE("without a frequency axis borders are found along what there is") {
  const Borders found =
      borders_of(oscillator() + axis("f", 0.1, 0.95, 4) + axis("zeta", 0.03, 0.4, 5) + with_borders);
  int along[] = {0, 0, 0};
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found["regime_below"][i] != non_stop && found["regime_above"][i] != non_stop) continue;
    ++along[std::lround(found["axis"][i])];
    const double zeta = found["zeta"][i];
    CHECK_THAT(found["f"][i], Catch::WithinAbs(critical_friction(0.9, zeta), place_tolerance * (0.3 + 0.1)));
  }
  CHECK(along[1] == 5);
}

// On each edge of the map the regimes of its borders lead from that of one end to that of the other, and
// there are none where both are the same. Returns on how many edges third regimes lie between.
std::size_t check_chains(const Map& map, const Borders& found, const std::vector<std::string>& axes) {
  std::vector<std::size_t> shape;
  for (const std::string& name : axes) shape.push_back(map.coordinate(name).size());
  const auto& regime = map["friction_regime"];
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> on_edge;  // lower point, dimension
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto along = static_cast<std::size_t>(found["axis"][i]) - 1;
    std::size_t lower = 0;
    for (std::size_t d = 0; d < axes.size(); ++d) {
      const auto& values = map.coordinate(axes[d]);
      const auto above = std::ranges::upper_bound(values, found[axes[d]][i]);
      lower = lower * shape[d] + static_cast<std::size_t>(above - values.begin()) - 1;
      if (d != along) CHECK(std::ranges::find(values, found[axes[d]][i]) != values.end());
    }
    on_edge[{lower, along}].push_back(i);
  }
  std::size_t crossed = 0, between = 0, stride = 1;
  for (std::size_t d = axes.size(); d-- > 0; stride *= shape[d]) {
    for (std::size_t lower = 0; lower < regime.size(); ++lower) {
      if (lower / stride % shape[d] + 1 == shape[d]) continue;
      const double below = regime[lower], above = regime[lower + stride];
      const auto& borders = on_edge[{lower, d}];
      if (below == above || below < non_stop || above < non_stop) {
        CHECK(borders.empty());
        continue;
      }
      ++crossed;
      between += borders.size() > 1;
      REQUIRE_FALSE(borders.empty());
      CHECK(found["regime_below"][borders.front()] == below);
      CHECK(found["regime_above"][borders.back()] == above);
      for (std::size_t k = 1; k < borders.size(); ++k) {
        CHECK(found["regime_above"][borders[k - 1]] == found["regime_below"][borders[k]]);
        CHECK(found[axes[d]][borders[k - 1]] < found[axes[d]][borders[k]]);
      }
    }
  }
  CHECK(crossed > 100);
  return between;
}

TEST_CASE("on every edge, also between tiles, the borders lead from the regime of one end to the other's") {
  const std::string all = "[output]\nborders = true\n";
  std::size_t between = 0;
  // Tiles of whole rows of r, some of f and one of zeta; and long rows that are cut.
  for (const std::string& axes :
       {axis("zeta", 0.03, 0.3, 3) + axis("f", 0, 0.97, 8) + axis("r", 0.12, 1.9, 97),
        axis_of("zeta", "[0.05, 0.2]") + axis_of("f", "[0.3, 0.6, 0.9, 1.2]") + axis("r", 0.08, 2, 4500)}) {
    const Folder folder;
    REQUIRE(grown_maps::run(folder.write("map.toml", oscillator() + axes + all), folder / "map.h5").code ==
            0);
    between += check_chains(read_map(folder / "map.h5"), Borders(folder / "map.h5"), {"zeta", "f", "r"});
  }
  CHECK(between > 3);
}

TEST_CASE("the map's values have no borders to thank for, nor have the borders points taken over") {
  const Folder folder;
  const std::string axes = axis("f", 0.05, 1.1, 9) + axis("r", 0.2, 1.9, 301);
  const std::string old_study = folder.write("old.toml", oscillator() + axes + "[output]\n");
  const std::string study = folder.write("new.toml", oscillator() + axes + "[output]\nborders = true\n");
  REQUIRE(grown_maps::run(old_study, folder / "old.h5").code == 0);
  REQUIRE(grown_maps::run(study, folder / "new.h5").code == 0);
  const Map old_map = read_map(folder / "old.h5"), new_map = read_map(folder / "new.h5");
  for (std::size_t i = 0; i < grown_maps::variable_size(old_map); ++i)
    REQUIRE(grown_maps::same_point(old_map, i, new_map, i));
  CHECK_FALSE(frahm::results::MapReader(folder / "old.h5").has_group("borders"));

  const auto grown = grown_maps::run(study, folder / "grown.h5", {"--from", folder / "old.h5"});
  REQUIRE(grown.code == 0);
  CHECK(grown_maps::points_of(grown.out) == grown_maps::Points{9 * 301, 0});
  CHECK(Borders(folder / "grown.h5") == Borders(folder / "new.h5"));
  // A map with borders is another one than the map without: its logs are never mixed.
  CHECK(grown_maps::provenance(folder / "old.h5", "fingerprint_grid") !=
        grown_maps::provenance(folder / "new.h5", "fingerprint_grid"));
  CHECK(grown_maps::provenance(folder / "old.h5", "fingerprint_physics") ==
        grown_maps::provenance(folder / "new.h5", "fingerprint_physics"));
}

TEST_CASE("points that fail end no border, and the others have theirs") {
  const Folder folder;
  const std::string study = oscillator("\"k\"") + axis_of("k", "[1, -1, 1.2]") +
                            axis_of("f", "[0, 0.3, 1.1]") + axis_of("r", "[0.6, 0.8]") + with_borders;
  REQUIRE(grown_maps::run(folder.write("map.toml", study), folder / "map.h5").code == 3);
  const Borders found(folder / "map.h5");
  REQUIRE(found.size() > 0);
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found["k"][i] >= 1.0);
    CHECK(found["f"][i] > 0.3);
    CHECK(found["axis"][i] != 1);
  }
}

TEST_CASE("a map without a border has an empty group of them") {
  const Borders found =
      borders_of(oscillator() + axis_of("f", "[0.01, 0.02]") + axis("r", 0.8, 1.2, 5) + with_borders);
  CHECK(found.size() == 0);
  CHECK(found.columns.size() == 6);
}

TEST_CASE("a part of a map has the borders of its tiles") {
  const Folder folder;
  const std::string study = folder.write(
      "map.toml", oscillator() + axis("f", 0.05, 1.1, 9) + axis("r", 0.2, 1.9, 301) + with_borders);
  REQUIRE(grown_maps::run(study, folder / "map.h5").code == 0);
  const std::size_t all = Borders(folder / "map.h5").size();
  for (const char* shard : {"0/2", "1/2"})
    REQUIRE(grown_maps::run(study, folder / "part.h5", {"--shard", shard}).code == 0);
  REQUIRE(runs::frahm({"merge", folder / "part.h5", "--progress", "none"}).code == 0);
  CHECK(Borders(folder / "part.h5") == Borders(folder / "map.h5"));
  REQUIRE(grown_maps::run(study, folder / "one.h5", {"--shard", "0/2"}).code == 0);
  REQUIRE(runs::frahm({"merge", folder / "one.h5", "--partial", "--progress", "none"}).code == 0);
  const std::size_t part = Borders(folder / "one.h5").size();
  CHECK(part > 0);
  CHECK(part < all);
}

// Of an element under friction between a moving base and a mass.
TEST_CASE("the orbits kept have the sliding of each friction element, whose loops are its energy") {
  std::string study = oscillator();
  study.replace(study.find("[[excitation.force]]"), std::string::npos,
                "[[excitation.motion]]\nnode = \"base\"\namplitude = 1\n");
  const std::string ground = "between = [\"ground\", \"main\"]";
  study.replace(study.rfind(ground), ground.size(), "between = [\"base\", \"main\"]");
  const Folder folder;
  const auto outcome = grown_maps::run(
      folder.write("map.toml", study + axis_of("f", "[0.1]") + axis_of("r", "[0.8]") +
                                   "[output]\nquantities = \"all\"\norbits = [{ r = 0.8, f = 0.1 }]\n"),
      folder / "map.h5");
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  std::map<std::string, std::vector<double>> orbit;
  for (const auto& column : frahm::results::MapReader(folder / "map.h5").columns("orbits"))
    orbit[column.variable.name] = column.values;
  const auto &u = orbit["friction_displacement"], &v = orbit["friction_sliding_velocity"];
  REQUIRE(u.size() == 512);
  double loop = 0.0, most = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double phase = 0.8 * orbit["time"][i];
    CHECK_THAT(u[i], Catch::WithinAbs(orbit["main_displacement"][i] - std::cos(phase), 1e-12));
    CHECK_THAT(v[i], Catch::WithinAbs(orbit["main_velocity"][i] + 0.8 * std::sin(phase), 1e-12));
    CHECK(orbit["friction_force"][i] * v[i] >= -1e-12);
    most = std::max(most, std::abs(u[i]));
    if (i > 0)
      loop += 0.5 * (orbit["friction_force"][i] + orbit["friction_force"][i - 1]) * (u[i] - u[i - 1]);
  }
  const Map map = read_map(folder / "map.h5");
  CHECK_THAT(loop, Catch::WithinRel(map["friction_energy"][0], 1e-3));  // of 512 samples, two at corners
  CHECK_THAT(most, Catch::WithinRel(map["friction_stroke"][0], 1e-3));
}

}  // namespace
}  // namespace borders_test
