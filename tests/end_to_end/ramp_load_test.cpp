// ramp_load.toml: a map of motions under a ramp given by its corners, against the closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace ramp_load_test {
namespace {

TEST_CASE("ramp_load.toml: the dynamic load factor is 1 + |sin(pi t_r/T)|/(pi t_r/T)") {
  const runs::Map map = runs::run_study(runs::reduced("ramp_load", {}));
  const auto &peak = map["frame_peak"], &ratios = map.coordinate("ratio");
  REQUIRE(peak.size() == ratios.size());
  for (std::size_t i = 0; i < peak.size(); ++i) {
    const double x = std::numbers::pi * ratios[i];
    const double stiffness = 20e3 * std::pow(2.0 * x / 0.2, 2);
    INFO("t_r/T = " << ratios[i]);
    CHECK(map["status"][i] == 1.0);
    CHECK(map["energy_balance"][i] < 1e-9);
    // The force is 10 kN.
    CHECK(std::abs(peak[i] * stiffness / 10e3 - (1.0 + std::abs(std::sin(x)) / x)) < 1e-9);
  }
}

}  // namespace
}  // namespace ramp_load_test
