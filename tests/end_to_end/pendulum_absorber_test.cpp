// A pendulum absorber on a tower, against Lagrange's equations solved by complex numbers.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "tests/end_to_end/runs.hpp"

namespace pendulum_absorber_test {
namespace {

using Complex = std::complex<double>;

constexpr double M = 100.0, m = 5.0, K = 2600.0, C = 10.0, P = 10.0, g = 9.80665, l = g / 25.0;
constexpr double tolerance = 1e-10;  // relative: the response is linear

TEST_CASE(
    "pendulum_absorber.toml: without friction the tower rests at omega^2 = g/l and the bob takes the force") {
  const runs::Map map = runs::run_study(runs::reduced("pendulum_absorber", {}));
  const auto& omega = map.coordinate("omega");
  int at_rest = 0;
  for (std::size_t i = 0; i < omega.size(); ++i) {
    const Complex s(0.0, omega[i]);
    // (M + m) x'' + m l theta'' + C x' + K x = P,  m l x'' + m l^2 theta'' + m g l theta = 0
    const Complex a = (M + m) * s * s + C * s + K, coupling = m * l * s * s;
    const double own = m * l * (g - l * omega[i] * omega[i]);
    const Complex determinant = a * own - coupling * coupling;
    INFO("omega " << omega[i]);
    CHECK_THAT(map["pendulum_amplitude"][i],
               Catch::WithinRel(std::abs(coupling / determinant) * P, tolerance));
    CHECK_THAT(map["tower_amplitude"][i],
               Catch::WithinRel(std::abs(own / determinant) * P, tolerance) || Catch::WithinAbs(0.0, 1e-13));
    CHECK_THAT(map["force_transmissibility"][i],
               Catch::WithinRel(std::abs((K + C * s) * own / determinant), tolerance) ||
                   Catch::WithinAbs(0.0, 1e-12));
    if (std::abs(omega[i] - 5.0) > 1e-9) continue;
    ++at_rest;
    CHECK(map["tower_amplitude"][i] < 1e-13);
    CHECK_THAT(map["pendulum_amplitude"][i], Catch::WithinRel(P / (m * g), tolerance));
  }
  CHECK(at_rest == 1);
}

TEST_CASE("pendulum_absorber.toml: the natural frequencies are the roots of Frahm's equation") {
  const runs::Map map = runs::run_study(runs::reduced("pendulum_absorber", {{"omega", 3}}));
  // (K - (M + m) w^2)(g - l w^2) = m l w^4, a quadratic in w^2.
  const double a = M * l, b = -(K * l + (M + m) * g), c = K * g, root = std::sqrt(b * b - 4.0 * a * c);
  CHECK_THAT(map["natural_frequency_1"][0], Catch::WithinRel(std::sqrt((-b - root) / (2.0 * a)), tolerance));
  CHECK_THAT(map["natural_frequency_2"][0], Catch::WithinRel(std::sqrt((-b + root) / (2.0 * a)), tolerance));
}

TEST_CASE("pendulum_absorber.toml: friction keeps the pendulum from swinging, and the tower moves") {
  const runs::Map map = runs::run_study(runs::reduced("pendulum_absorber", {}));
  const std::size_t count = map.coordinate("omega").size();
  const auto& omega = map.coordinate("omega");
  const auto tuned = static_cast<std::size_t>(
      std::ranges::find_if(omega, [](double each) { return each > 5.0 - 1e-9; }) - omega.begin());
  for (std::size_t i = 0; i < 3 * count; ++i) CHECK(map["energy_balance"][i] < 1e-9);
  CHECK(map["tower_amplitude"][tuned] < map["tower_amplitude"][count + tuned]);
  CHECK(map["tower_amplitude"][count + tuned] < map["tower_amplitude"][2 * count + tuned]);
  // The hinge takes 4 T a period and swing, as it does not stop there.
  CHECK(map["hinge_regime"][count + tuned] == 2.0);
  CHECK_THAT(map["hinge_energy"][count + tuned],
             Catch::WithinRel(4.0 * 0.1 * map["pendulum_amplitude"][count + tuned], 1e-10));
}

}  // namespace
}  // namespace pendulum_absorber_test
