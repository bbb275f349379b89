// The lecture's cases of one mass: isolation, unbalance, springs, cantilever, instrument.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace lecture_test {
namespace {

using Complex = std::complex<double>;
using runs::Map;

constexpr double pi = std::numbers::pi;
constexpr double tolerance = 1e-10;  // relative: linear responses are exact but for roundings

// Magnification 1/|1 - r^2 + 2 i zeta r| as a complex number.
Complex magnification(double r, double zeta) {
  return 1.0 / Complex(1.0 - r * r, 2.0 * zeta * r);
}

TEST_CASE("lecture_isolation.toml: force and displacement transmissibility are one curve, 1 at r = sqrt(2)") {
  const Map map = runs::run_study(runs::reduced("lecture_isolation", {}));
  const auto& ratios = map.coordinate("frequency_ratio");
  const auto &force = map["transmitted_force"], &motion = map["instrument_amplitude"];
  std::size_t point = 0, crossings = 0;
  for (const double zeta : map.coordinate("zeta")) {
    for (const double r : ratios) {
      const double expected = std::abs(Complex(1.0, 2.0 * zeta * r) * magnification(r, zeta));
      INFO("zeta " << zeta << ", r " << r);
      CHECK_THAT(force[point], Catch::WithinRel(expected, tolerance));
      CHECK_THAT(motion[point], Catch::WithinRel(expected, tolerance));
      if (std::abs(r - std::sqrt(2.0)) < 1e-12) {
        ++crossings;
        CHECK_THAT(force[point], Catch::WithinAbs(1.0, tolerance));
      }
      const std::size_t less_damped = point - ratios.size();
      if (point >= ratios.size() && r > 1.415) CHECK(force[point] > force[less_damped]);
      if (point >= ratios.size() && r < 1.413) CHECK(force[point] < force[less_damped]);
      ++point;
    }
  }
  CHECK(crossings == map.coordinate("zeta").size());
}

TEST_CASE("lecture_unbalance.toml: the force m_e e omega^2 gives r^2 V, and m_e e/M at high speed") {
  const Map map = runs::run_study(runs::reduced("lecture_unbalance", {}));
  constexpr double at_infinity = 0.5 * 0.1 / 100.0;  // m_e e / M [m]
  const auto& speeds = map.coordinate("speed");
  std::size_t point = 0;
  for (const double zeta : map.coordinate("zeta")) {
    std::size_t highest = point;
    for (const double rpm : speeds) {
      const double r = rpm * pi / 30.0 / 100.0;
      const double expected = at_infinity * r * r * std::abs(magnification(r, zeta));
      INFO("zeta " << zeta << ", r " << r);
      CHECK_THAT(map["machine_peak"][point], Catch::WithinRel(expected, tolerance));
      CHECK_THAT(
          map["force_transmissibility"][point],
          Catch::WithinRel(std::abs(Complex(1.0, 2.0 * zeta * r) * magnification(r, zeta)), tolerance));
      if (map["machine_peak"][point] > map["machine_peak"][highest]) highest = point;
      ++point;
    }
    CHECK_THAT(map["machine_peak"][point - 1], Catch::WithinRel(at_infinity, 0.05));  // 1/r^2 left, r = 5.2
    if (zeta >= std::sqrt(0.5)) continue;                                             // no maximum
    const double peak_rpm = 100.0 / std::sqrt(1.0 - 2.0 * zeta * zeta) * 30.0 / pi;
    const double found = speeds[highest % speeds.size()];
    CHECK(std::abs(found - peak_rpm) <= 10.0);  // a grid of 10 rpm
  }
}

TEST_CASE(
    "lecture_springs.toml: parallel springs add their stiffnesses, springs in series their compliances") {
  const Map map = runs::run_study(runs::reduced("lecture_springs", {}));
  constexpr double k1 = 1000.0, k3 = 1500.0, mass = 2.5, P = 10.0, omega = 0.1;
  std::size_t point = 0;
  for (const double k2 : map.coordinate("k_2")) {
    const double parallel = k1 + k2, series = k1 * k2 / (k1 + k2), both = parallel * k3 / (parallel + k3);
    double stiffness[3] = {parallel, series, both};
    const auto deflection = [&](double k) { return P / std::abs(Complex(k - mass * omega * omega, omega)); };
    INFO("k_2 = " << k2);
    CHECK_THAT(map["on_parallel_peak"][point], Catch::WithinRel(deflection(parallel), tolerance));
    CHECK_THAT(map["on_series_peak"][point], Catch::WithinRel(deflection(series), tolerance));
    CHECK_THAT(map["on_both_peak"][point], Catch::WithinRel(deflection(both), tolerance));
    // Springs in parallel share the force as their stiffnesses.
    CHECK_THAT(map["parallel_2_force_peak"][point] / map["parallel_1_force_peak"][point],
               Catch::WithinRel(k2 / k1, tolerance));
    std::sort(std::begin(stiffness), std::end(stiffness));
    for (int i = 0; i < 3; ++i) {
      CHECK_THAT(map["natural_frequency_" + std::to_string(i + 1)][point],
                 Catch::WithinRel(std::sqrt(stiffness[i] / mass), tolerance));
    }
    ++point;
  }
}

TEST_CASE("lecture_cantilever.toml: the stiffness is 3 E I / L^3") {
  const Map map = runs::run_study(runs::reduced("lecture_cantilever", {{"omega", 31}}));
  std::size_t point = 0, length = 0;
  for (const double mm : map.coordinate("L")) {
    const double L = mm / 1000.0, k = 3.0 * 210e9 * (0.03 * std::pow(0.003, 3) / 12.0) / (L * L * L);
    const double natural = std::sqrt(k / 1.88);
    CHECK_THAT(map.coordinate("stiffness")[length++], Catch::WithinRel(k, tolerance));
    for (const double hertz : map.coordinate("omega")) {
      INFO("L " << L << " m, " << hertz << " Hz");
      const double expected = std::abs(magnification(2.0 * pi * hertz / natural, 0.01)) / k;
      CHECK_THAT(map["natural_frequency_1"][point], Catch::WithinRel(natural, tolerance));
      CHECK_THAT(map["tip_peak"][point], Catch::WithinRel(expected, tolerance));
      ++point;
    }
    if (mm == 200.0) CHECK(std::abs(natural - 53.174) < 0.0005);
  }
}

TEST_CASE(
    "lecture_instrument.toml: the stroke is r^2 V: accelerometer below resonance, displacement meter above") {
  const Map map = runs::run_study(runs::reduced("lecture_instrument", {}));
  std::size_t point = 0;
  double accelerometer_error = 0.0, meter_error = 0.0;  // at zeta = 0.7
  for (const double zeta : map.coordinate("zeta")) {
    for (const double r : map.coordinate("r")) {
      const double stroke = map["spring_stroke"][point++];
      INFO("zeta " << zeta << ", r " << r);
      CHECK_THAT(stroke, Catch::WithinRel(r * r * std::abs(magnification(r, zeta)), tolerance));
      if (zeta != 0.7) continue;
      if (r < 0.401) accelerometer_error = std::max(accelerometer_error, std::abs(stroke / (r * r) - 1.0));
      if (r > 1.999) meter_error = std::max(meter_error, std::abs(stroke - 1.0));
    }
  }
  CHECK(accelerometer_error < 0.01);
  CHECK(meter_error < 0.03);
}

}  // namespace
}  // namespace lecture_test
