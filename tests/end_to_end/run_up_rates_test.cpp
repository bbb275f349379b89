// run_up_rates.toml: a map of run-ups, against the steady state at resonance.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/end_to_end/runs.hpp"

namespace run_up_rates_test {
namespace {

TEST_CASE(
    "run_up_rates.toml: a faster run-up sways less, below the steady state, and the more so with less "
    "damping") {
  const runs::Map map = runs::run_study(runs::reduced("run_up_rates", {}));
  const auto& peak = map["machine_peak"];
  constexpr double me = 0.16, M = 200.0;
  constexpr std::size_t rates = 4;
  REQUIRE(peak.size() == 2 * rates);
  for (std::size_t i = 0; i < 2; ++i) {
    const double zeta = map.coordinate("zeta")[i];
    const double steady = me / (2.0 * zeta * std::sqrt(1.0 - zeta * zeta) * M);
    CHECK(peak[rates * i] < steady);
    for (std::size_t j = 0; j < rates; ++j) {
      const std::size_t at = rates * i + j;
      INFO("zeta = " << zeta << ", rate " << j);
      CHECK((j == 0 || peak[at] < peak[at - 1]));
      CHECK(map["status"][at] == 1.0);
      CHECK(map["discretisation_error"][at] < 1e-6 * peak[at]);
      CHECK(map["energy_balance"][at] < 1e-9);
      // It peaks behind the resonance at 50 rad/s, which it passes at that time.
      const double rate = map.coordinate("alpha")[j] * std::acos(-1.0) / 30.0;
      const double passes = (50.0 - 100.0 * std::acos(-1.0) / 30.0) / rate;
      CHECK(map["machine_peak_time"][at] > passes);
    }
  }
  CHECK(peak[rates - 1] / peak[0] < peak[2 * rates - 1] / peak[rates]);
}

}  // namespace
}  // namespace run_up_rates_test
