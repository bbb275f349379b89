#include "solvers/mechanics/crank.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/known_answers/responses.hpp"

namespace frahm::mechanics::crank_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double rig_radius = 0.02955, rig_rod = 0.12;  // [m]

// The crank's displacement by its definition, with the square root as it stands.
double defined_displacement(double radius, double rod, double theta) {
  const double c = radius * std::cos(theta);
  return radius * std::sin(theta) + std::sqrt(rod * rod - c * c) - rod;
}

double summed(double radius, const std::vector<double>& even, double theta) {
  double sum = radius * std::sin(theta);
  for (std::size_t m = 0; m < even.size(); ++m)
    sum += even[m] * std::cos(2.0 * static_cast<double>(m) * theta);
  return sum;
}

TEST_CASE("A crank's Fourier series is its displacement to 1e-14 of the crank, at every angle and ratio") {
  for (const double ratio : {1e-3, 0.1, 0.24625, 0.5, 0.8, kLargestCrankRatio}) {
    const auto even = crank_even_orders(ratio, 1.0, crank_orders_needed(ratio));
    for (int i = 0; i < 360; ++i) {
      const double theta = i * pi / 180.0;
      INFO("ratio " << ratio << ", angle " << i);
      CHECK(std::abs(summed(ratio, even, theta) - crank_displacement(ratio, 1.0, theta)) < 1e-14 * ratio);
      // The definition loses the digits of L - sqrt(L^2 - c^2), an error of the rounding of L = 1.
      CHECK(std::abs(defined_displacement(ratio, 1.0, theta) - crank_displacement(ratio, 1.0, theta)) <
            4e-16);
    }
  }
}

TEST_CASE("The first even orders of a crank are those of its expansion in crank over rod") {
  // -R (R/4L) (1 + 3/16 (R/L)^2 + ...) and half of it at twice the angle: a relative rest of (R/L)^2
  const double ratio = 1e-3;
  const auto even = crank_even_orders(ratio, 1.0, 2);
  CHECK_THAT(even[0], Catch::WithinRel(-ratio * ratio / 4.0, ratio * ratio));
  CHECK_THAT(even[1], Catch::WithinRel(-ratio * ratio / 4.0, ratio * ratio));
  CHECK(std::abs(even[2]) < ratio * ratio * ratio * ratio);
}

TEST_CASE("Taylor cuts of the rig's crank miss l_AC by 0.0323, 4.93e-4 and 1.50e-5") {
  const struct {
    int order;
    double error, last_digit;
  } cuts[] = {{1, 0.0323, 1e-4}, {2, 4.93e-4, 1e-6}, {4, 1.50e-5, 1e-7}};
  for (const auto& cut : cuts) {
    const auto even = crank_even_orders(rig_radius, rig_rod, cut.order / 2, cut.order);
    double error = 0.0;
    for (int i = 0; i < 36000; ++i) {
      const double theta = i * pi / 18000.0;
      const double exact = defined_displacement(rig_radius, rig_rod, theta);
      error = std::max(error, std::abs(summed(rig_radius, even, theta) - exact) / (exact + rig_rod));
    }
    INFO("order " << cut.order << ": " << error);
    CHECK(std::abs(error - cut.error) < 0.5 * cut.last_digit);
  }
}

// A mass of 1 kg on a spring of 100 N/m to the crank and one of 60 N/m to ground, with a damper of 0.8 N s/m
// to the crank.
Network driven_by_crank(int even_orders, int taylor_order = 0) {
  const Node ground{}, mass{NodeKind::mass, 0}, slider{NodeKind::prescribed, 0};
  return {.masses = {"x"},
          .prescribed = {"slider"},
          .elements = {{"drive", ElementType::spring, slider, mass},
                       {"damper", ElementType::damper, slider, mass},
                       {"spring", ElementType::spring, ground, mass}},
          .excitations = {{ExcitationKind::crank, 0, 1, even_orders, taylor_order}}};
}

NetworkValues crank_values(double omega, double phase) {
  return {.omega = omega, .mass = {1.0}, .element = {100.0, 0.8, 60.0}, .excitation = {{0.05, phase, 0.12}}};
}

// The coefficient (1/pi) integral of a(theta) e^{-i n theta}, half of it for n = 0, by the trapezoidal rule.
std::complex<double> harmonic(int n) {
  constexpr int samples = 512;
  std::complex<double> sum = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double theta = 2.0 * pi * i / samples;
    sum += defined_displacement(0.05, 0.12, theta) * std::polar(2.0 / samples, -n * theta);
  }
  return n == 0 ? 0.5 * sum : sum;
}

// x(t) by superposition of the first harmonics, the rest far below rounding.
double superposed(double omega, double angle) {
  double x = 100.0 / 160.0 * harmonic(0).real();
  for (int n = 1; n <= 40; ++n) {
    const std::complex<double> s(0.0, n * omega);
    x += ((100.0 + 0.8 * s) / (160.0 + 0.8 * s + s * s) * harmonic(n) * std::polar(1.0, n * angle)).real();
  }
  return x;
}

TEST_CASE("The mean and the even orders of a crank are in the orbit of the mass that it drives") {
  constexpr double tolerance = 1e-13;  // [m], of displacements of some 0.1 m
  periodic::Responses responses(driven_by_crank(crank_orders_needed(0.05 / 0.12)));
  for (const double omega : {4.0, 6.3, 12.6, 20.0}) {  // about half the natural frequency, and at it
    const double phase = 0.7;
    REQUIRE(responses.solve(crank_values(omega, phase)).status == periodic::Status::ok);
    CHECK_THAT(responses["x_mean"], Catch::WithinAbs(100.0 / 160.0 * harmonic(0).real(), tolerance));
    const auto history = responses.response().history(frahm::periodic::phases_of_a_period(61));
    for (std::size_t i = 0; i < 61; ++i) {
      INFO("omega " << omega << ", sample " << i);
      const double angle = omega * history.time[i] + phase;
      CHECK_THAT(history.columns[0][i], Catch::WithinAbs(superposed(omega, angle), tolerance));
    }
    CHECK(responses["energy_balance"] < 1e-10);
  }
}

TEST_CASE("A crank cut at the first order is a harmonic motion") {
  periodic::Responses cut(driven_by_crank(0, 1));
  Network network = driven_by_crank(0);
  network.excitations = {{ExcitationKind::motion, 0, 1}};
  periodic::Responses harmonic(network);
  NetworkValues values = crank_values(11.0, 0.3);
  cut.solve(values);
  values.excitation = {{0.05, 0.3 - 0.5 * pi}};
  harmonic.solve(values);
  CHECK(cut["x_mean"] == 0.0);
  CHECK_THAT(cut["x_amplitude"], Catch::WithinRel(harmonic["x_amplitude"], 1e-14));
  CHECK_THAT(cut["x_phase"], Catch::WithinAbs(harmonic["x_phase"], 1e-13));
}

}  // namespace
}  // namespace frahm::mechanics::crank_test
