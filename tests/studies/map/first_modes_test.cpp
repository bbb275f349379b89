#include "studies/map/first_modes.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "results/map_reader.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"
#include "tests/studies/temporary_folder.hpp"

namespace first_modes_test {
namespace {

using namespace frahm::studies;
namespace results = frahm::results;

// The group /modes of a study, and its texts.
struct Modes {
  std::vector<results::Column> columns;
  std::vector<results::Text> texts;

  const std::vector<double>& values(const std::string& name) const {
    for (const results::Column& column : columns)
      if (column.variable.name == name) return column.values;
    throw std::out_of_range(name);
  }
};

Modes modes_of(const std::string& text) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "modes.h5";
  results::MapWriter writer(file, {.title = "modes"});
  write_modes(parse_study(text, "building.toml"), writer);
  writer.finish();
  const results::MapReader reader(file);
  return {reader.columns("modes"), reader.texts("modes")};
}

// A chain of n unit masses on unit springs from the ground has omega_k = 2 sin(a_k/2), a_k = (2k - 1) pi/(2n
// + 1), and mass j moves as sin(j a_k); its dampers of 0.02 beside the springs give zeta_k = 0.01 omega_k.
TEST_CASE("the file has the lowest modes of a building: frequencies, damping, shapes") {
  constexpr int n = 20;
  constexpr double rounding = 1e-12;
  const Modes modes = modes_of(small_studies::building(n, 3, 5));
  REQUIRE(modes.values("mode").size() == 12);
  for (std::size_t k = 0; k < 12; ++k) {
    const double a = (2.0 * static_cast<double>(k) + 1.0) * std::numbers::pi / (2.0 * n + 1.0);
    CHECK(modes.values("mode")[k] == static_cast<double>(k + 1));
    CHECK(modes.values("mode_frequency")[k] == Approx(2.0 * std::sin(a / 2.0)).epsilon(rounding));
    CHECK(modes.values("mode_damping")[k] == Approx(0.02 * std::sin(a / 2.0)).epsilon(rounding));
    const std::vector<double>& shape = modes.values("mode_shape_" + std::to_string(k + 1));
    REQUIRE(shape.size() == n);
    const double scale = shape[0] / std::sin(a);
    double largest = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      CHECK(shape[j] == Approx(scale * std::sin(static_cast<double>(j + 1) * a)).margin(1e3 * rounding));
      largest = std::max(largest, std::abs(shape[j]));
    }
    CHECK(largest == Approx(1.0).epsilon(rounding));
  }
}

TEST_CASE("the modes name the masses of their shapes, and the point, the first of the grid") {
  const Modes modes = modes_of(small_studies::building(3, 3, 5));
  CHECK(modes.values("mode_frequency").size() == 3);
  CHECK(modes.texts == std::vector<results::Text>{{"point", "r=0.02"}, {"masses", "floor1,floor2,floor3"}});
}

}  // namespace
}  // namespace first_modes_test
