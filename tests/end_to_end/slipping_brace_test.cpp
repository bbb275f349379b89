// A mass with a brace that slips.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/end_to_end/runs.hpp"

namespace slipping_brace_test {
namespace {

using runs::Map;

TEST_CASE("slipping_brace.toml: a loop takes 4 F (X - F/k_t), and a brace that never slips is a spring") {
  constexpr double kLoop = 1e-10, kLinear = 1e-10;  // relative
  const Map map = runs::run_study(runs::reduced("slipping_brace", {}));
  std::size_t point = 0;
  int slipping = 0;
  for (const double F : map.coordinate("F")) {
    for (const double r : map.coordinate("r")) {
      const double X = map["main_peak"][point], energy = map["brace_energy"][point];
      INFO("F " << F << ", r " << r);
      CHECK(map["status"][point] == 1.0);
      CHECK(map["energy_balance"][point] < 1e-10);
      if (map["brace_stuck_fraction"][point] == 1.0) {
        CHECK(X <= F * (1.0 + kLinear));
        CHECK_THAT(X, Catch::Matchers::WithinRel(1.0 / std::hypot(2.0 - r * r, 0.1 * r), kLinear));
      } else {
        // Loops of more reversals than two would take more; here the motion has none.
        CHECK_THAT(energy, Catch::Matchers::WithinRel(4.0 * F * (X - F), kLoop));
        ++slipping;
      }
      ++point;
    }
  }
  CHECK(slipping > 300);
}

}  // namespace
}  // namespace slipping_brace_test
