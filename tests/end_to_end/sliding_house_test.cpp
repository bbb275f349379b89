// sliding_house.toml: where the foundation rides with the ground, by the response of a fixed house.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace sliding_house_test {
namespace {

using Catch::Matchers::WithinRel;

TEST_CASE("sliding_house.toml: the foundation rides where friction carries the base shear of a fixed house") {
  constexpr double kExact = 1e-10;  // relative
  constexpr double a = 0.2 * 9.80665, g = 9.81, m_b = 15e3, m_h = 40e3, zeta = 0.04;
  constexpr double own = 3.0 * 2.0 * std::numbers::pi;  // of the fixed house [rad/s]
  constexpr int stuck = 5;
  const runs::Map map = runs::run_study(runs::reduced("sliding_house", {}));
  const auto &f = map.coordinate("f"), &mu = map.coordinate("mu");
  int riding = 0;
  for (std::size_t i = 0; i < f.size(); ++i)
    for (std::size_t j = 0; j < mu.size(); ++j) {
      INFO("f = " << f[i] << " Hz, mu = " << mu[j]);
      const std::size_t at = i * mu.size() + j;
      // Fixed: x/a = 1/(own^2 - w^2 + 2 i zeta own w), the base shear a m_b + m_h (own^2 + 2 i zeta own w) x.
      const double w = 2.0 * std::numbers::pi * f[i];
      const std::complex<double> walls(own * own, 2.0 * zeta * own * w);
      const std::complex<double> sway = a / (walls - w * w), shear = a * m_b + m_h * walls * sway;
      const bool rides = mu[j] * g * (m_b + m_h) >= std::abs(shear);
      CHECK((map["sliding_regime"][at] == stuck) == rides);
      CHECK(map["energy_balance"][at] < 1e-10);
      CHECK(std::abs(map["foundation_drift"][at]) < 1e-12);
      if (!rides) continue;
      ++riding;
      CHECK_THAT(map["sway_amplitude"][at], WithinRel(std::abs(sway), kExact));
      CHECK_THAT(map["foundation_amplitude"][at], WithinRel(a / (w * w), kExact));
    }
  CHECK(riding > 200);
  CHECK(riding < 400);
}

}  // namespace
}  // namespace sliding_house_test
