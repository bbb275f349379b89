// The lecture's materials carrying a mass: hysteretic, Kelvin-Voigt.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace lecture_materials_test {
namespace {

using Complex = std::complex<double>;
using runs::Map;

constexpr double pi = std::numbers::pi;
constexpr double tolerance = 1e-10;  // relative: linear responses are exact but for roundings

TEST_CASE(
    "lecture_hysteretic.toml: the peak is 1/eta at omega_n, the loss factor the same at every frequency") {
  const Map map = runs::run_study(runs::reduced("lecture_hysteretic", {}));
  std::size_t point = 0;
  for (const double eta : map.coordinate("eta")) {
    double highest = 0.0;
    for (const double r : map.coordinate("r")) {
      const Complex x = 1.0 / Complex(1.0 - r * r, eta);
      const double amplitude = map["main_amplitude"][point];
      INFO("eta " << eta << ", r " << r);
      CHECK_THAT(amplitude, Catch::WithinRel(std::abs(x), tolerance));
      CHECK_THAT(map["main_phase"][point], Catch::WithinAbs(-std::arg(x), tolerance));
      CHECK_THAT(map["material_energy"][point] / (pi * amplitude * amplitude),
                 Catch::WithinRel(eta, tolerance));
      if (r == 0.01) CHECK_THAT(map["main_phase"][point], Catch::WithinAbs(std::atan(eta), 1e-4));  // r^2
      highest = std::max(highest, amplitude);
      ++point;
    }
    CHECK_THAT(highest, Catch::WithinRel(1.0 / eta, tolerance));
  }
}

TEST_CASE("lecture_kelvin_voigt.toml: the loss factor is 2 zeta r, and a constant load only moves the mean") {
  const Map map = runs::run_study(runs::reduced("lecture_kelvin_voigt", {}));
  std::size_t point = 0;
  for (const double zeta : map.coordinate("zeta")) {
    for (const double r : map.coordinate("r")) {
      const Complex x = 1.0 / Complex(1.0 - r * r, 2.0 * zeta * r);
      const double amplitude = map["main_amplitude"][point];
      INFO("zeta " << zeta << ", r " << r);
      CHECK_THAT(amplitude, Catch::WithinRel(std::abs(x), tolerance));
      CHECK_THAT(map["main_mean"][point], Catch::WithinRel(0.3, tolerance));
      CHECK_THAT(map["spring_force_peak"][point], Catch::WithinRel(0.3 + std::abs(x), tolerance));
      CHECK_THAT(map["damper_energy"][point] / (pi * amplitude * amplitude),
                 Catch::WithinRel(2.0 * zeta * r, tolerance));
      CHECK_THAT(map["transmitted_force"][point],
                 Catch::WithinRel(0.3 + std::abs(Complex(1.0, 2.0 * zeta * r) * x), tolerance));
      ++point;
    }
  }
}

}  // namespace
}  // namespace lecture_materials_test
