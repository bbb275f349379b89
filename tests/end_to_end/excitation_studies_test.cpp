// Studies of other friction values and excitations: mu N, several components, a base with an inerter.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "solvers/orbits/closed_forms.hpp"
#include "tests/end_to_end/runs.hpp"

namespace excitation_studies_test {
namespace {

using Complex = std::complex<double>;
using runs::Map;

constexpr double pi = std::numbers::pi;
constexpr double tolerance = 1e-10;  // relative: linear responses are exact but for roundings

TEST_CASE("friction_mu_n.toml: amplitudes are Den Hartog's with f = mu m g/P") {
  const Map map = runs::run_study(runs::reduced("friction_mu_n", {}));
  constexpr double m = 5.0, g = 9.80665, k = 2000.0, P = 20.0, natural = 20.0,
                   zeta = 4.0 / (2.0 * m * natural);
  int compared = 0;
  std::size_t point = 0;
  for (const double mu : map.coordinate("mu")) {
    for (const double omega : map.coordinate("omega")) {
      const std::size_t at = point++;
      const double expected = frahm::periodic::classical_amplitude(omega / natural, zeta, mu * m * g / P);
      if (mu * m * g >= P) CHECK(map["table_regime"][at] == 5.0);
      if (std::isnan(expected)) continue;
      INFO("mu " << mu << ", omega " << omega);
      CHECK_THAT(map["block_amplitude"][at] * k / P,
                 Catch::WithinAbs(expected, tolerance * std::max(1.0, expected)));
      ++compared;
    }
  }
  CHECK(compared > 11 * 86 * 3 / 4);
}

TEST_CASE("friction_mu_n.toml: at resonance the amplitude falls faster and faster as friction grows") {
  const Map map = runs::run_study(runs::reduced("friction_mu_n", {}));
  const auto& omega = map.coordinate("omega");
  const auto resonance = static_cast<std::size_t>(
      std::find_if(omega.begin(), omega.end(), [](double each) { return each > 20.0 - 1e-9; }) -
      omega.begin());
  REQUIRE(std::abs(omega[resonance] - 20.0) < 1e-9);
  const auto amplitude = [&](std::size_t mu) {
    return map["block_amplitude"][mu * omega.size() + resonance];
  };
  for (std::size_t mu = 1; map["table_regime"][(mu + 1) * omega.size() + resonance] < 5.0; ++mu) {
    INFO("mu " << map.coordinate("mu")[mu]);
    CHECK(amplitude(mu + 1) / amplitude(mu) < amplitude(mu) / amplitude(mu - 1));
  }
}

// Complex amplitudes of lower and upper at an angular frequency, by Cramer's rule.
struct Amplitudes {
  Complex lower, upper;
};
Amplitudes two_masses(double omega, Complex on_lower, Complex on_upper) {
  const Complex s(0.0, omega), link = 900.0 + 4.0 * s;
  const Complex a = 3.0 * s * s + 6.0 * s + 2000.0 + link, b = 2.0 * s * s + 3.0 * s + 500.0 + link;
  const Complex determinant = a * b - link * link;
  return {(on_lower * b + link * on_upper) / determinant, (a * on_upper + link * on_lower) / determinant};
}

TEST_CASE("several_components.toml: without friction every component acts by itself") {
  const Map map = runs::run_study(runs::reduced("several_components", {}));
  const Amplitudes still = two_masses(0.0, 0.0, 7.0);
  const auto& frequencies = map.coordinate("omega");
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    const double omega = frequencies[i];
    const Complex motion = 0.004 * Complex(1.0, 1.0);  // two of them, 90 degrees apart
    const Amplitudes first = two_masses(omega, 12.0, 0.0);
    const Amplitudes second = two_masses(2.0 * omega, 0.0, Complex(500.0, 3.0 * 2.0 * omega) * motion);
    const Amplitudes third = two_masses(3.0 * omega, std::polar(5.0, 40.0 * pi / 180.0), 0.0);
    const auto rms = [](Complex mean, Complex x, Complex y, Complex z) {
      return std::sqrt(std::norm(mean) + 0.5 * (std::norm(x) + std::norm(y) + std::norm(z)));
    };
    INFO("omega " << omega);
    CHECK_THAT(map["lower_mean"][i], Catch::WithinRel(still.lower.real(), tolerance));
    CHECK_THAT(map["upper_mean"][i], Catch::WithinRel(still.upper.real(), tolerance));
    CHECK_THAT(map["lower_rms"][i],
               Catch::WithinRel(rms(still.lower, first.lower, second.lower, third.lower), tolerance));
    CHECK_THAT(map["upper_rms"][i],
               Catch::WithinRel(rms(still.upper, first.upper, second.upper, third.upper), tolerance));
    CHECK(std::abs(std::remainder(map["lower_phase"][i] + std::arg(first.lower), 2.0 * pi)) < tolerance);
  }
  for (const double balance : map["energy_balance"]) CHECK(balance < tolerance);
  for (const double radius : map["floquet_radius"]) CHECK(radius < 1.0);
}

TEST_CASE("base_through_inerter.toml: the inerter makes an antiresonance and spoils isolation") {
  const Map map = runs::run_study(runs::reduced("base_through_inerter", {}));
  std::size_t point = 0;
  int standstills = 0;
  for (const double beta : map.coordinate("beta")) {
    for (const double zeta : map.coordinate("zeta")) {
      for (const double r : map.coordinate("r")) {
        const std::size_t at = point++;
        const Complex through(1.0 - beta * r * r, 2.0 * zeta * r);
        const double expected = std::abs(through / (through - r * r)), found = map["main_amplitude"][at];
        INFO("beta " << beta << ", zeta " << zeta << ", r " << r);
        const bool unbounded = beta == 0.0 && zeta == 0.0 && std::abs(r - 1.0) < 1e-12;
        CHECK((map["status"][at] == 3.0) == unbounded);
        if (unbounded) continue;
        CHECK_THAT(found, Catch::WithinAbs(expected, tolerance * std::max(1.0, expected)));
        if (zeta == 0.0 && std::abs(beta * r * r - 1.0) < 1e-12) {
          ++standstills;
          CHECK(found < 1e-12);
        }
      }
    }
  }
  CHECK(standstills == 3);
}

}  // namespace
}  // namespace excitation_studies_test
