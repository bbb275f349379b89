// rig_atlas.toml and rig_without_absorber.toml on reduced grids.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace rig_test {
namespace {

using runs::Map;

constexpr double pi = std::numbers::pi;
constexpr double linear_tolerance = 1e-11;  // [m]: the linear response is exact but for roundings

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

// Amplitude of the main mass alone, without friction, at omega [rad/s].
double linear_amplitude(double omega) {
  const double m = 102.66, c = 1.7688, k = 7 * 8181.0, force = 8181.0 * 0.02955;
  return force / std::abs(std::complex<double>(k - m * omega * omega, c * omega));
}

TEST_CASE("rig_atlas.toml: every point is solved, balanced and stable") {
  const Map map = runs::run_study(runs::reduced("rig_atlas", {{"I", 4}, {"FP", 5}, {"omega", 81}}));
  for (const double status : map["status"]) CHECK((status == 1.0 || status == 2.0));
  CHECK(largest(map["energy_balance"]) < 1e-10);
  CHECK(largest(map["residual"]) < 1e-12);
  CHECK(largest(map["floquet_radius"]) < 1.0);
  CHECK(largest(map["main_peak"]) > 0.1);  // at the low resonance with the smallest inertance
}

TEST_CASE("rig_atlas.toml: its axes carry the units of the study and the ratios beside them") {
  const Map map = runs::run_study(runs::reduced("rig_atlas", {{"I", 2}, {"FP", 2}, {"omega", 11}}));
  REQUIRE(map.layout.axes.size() == 3);
  CHECK(map.layout.axes[0].coordinates[0].unit == "kg");
  CHECK(map.layout.axes[2].coordinates[0].unit == "rpm");
  CHECK(map.coordinate("omega").back() == 350.0);
  const double ratio = 350.0 * 2 * pi / 60 / std::sqrt(7 * 8181.0 / 102.66);
  CHECK_THAT(map.coordinate("frequency_ratio").back(), Catch::WithinRel(ratio, 1e-14));
  CHECK_THAT(map.coordinate("inertance_ratio").front(), Catch::WithinRel(4.72 / 102.66, 1e-14));
}

TEST_CASE("rig_atlas.toml: the resonant peak falls monotonically with the friction") {
  const Map map = runs::run_study(runs::reduced("rig_atlas", {{"I", 2}, {"FP", 7}, {"omega", 201}}));
  for (std::size_t i = 0; i < 2; ++i) {
    double before = 1.0;
    for (std::size_t f = 0; f < 7; ++f) {
      const auto row = map["main_peak"].begin() + static_cast<std::ptrdiff_t>((i * 7 + f) * 201);
      const double peak = *std::max_element(row, row + 201);
      CHECK(peak < before);
      before = peak;
    }
  }
}

TEST_CASE("rig_without_absorber.toml: without friction the response is the linear one") {
  const Map map = runs::run_study(runs::reduced("rig_without_absorber", {{"FP", 3}, {"omega", 41}}));
  for (std::size_t j = 0; j < 41; ++j) {
    const double omega = map.coordinate("omega")[j] * 2 * pi / 60;
    CHECK_THAT(map["main_amplitude"][j], Catch::WithinAbs(linear_amplitude(omega), linear_tolerance));
    CHECK(map["main_amplitude"][82 + j] < linear_amplitude(omega));
  }
}

}  // namespace
}  // namespace rig_test
