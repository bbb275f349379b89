#include "solvers/response/resonance_peak.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace frahm::periodic::resonance_peak_test {
namespace {

using Catch::Matchers::WithinAbs;
constexpr double kSolved = 1e-10;

std::vector<double> grid(double from, double to, int points) {
  std::vector<double> places;
  for (int i = 0; i < points; ++i) places.push_back(from + (to - from) * i / (points - 1));
  return places;
}

// Viscous damping: |X| = 1 / sqrt((1 - r^2)^2 + (2 zeta r)^2).
double viscous(double r, double zeta) {
  return 1.0 / std::hypot(1.0 - r * r, 2.0 * zeta * r);
}

TEST_CASE(
    "a viscous peak stands at sqrt(1 - 2 zeta^2), its half-power points where the curve is 1/sqrt(2) of it") {
  for (const double zeta : {0.001, 0.01, 0.05, 0.1, 0.3, 0.38}) {
    INFO("zeta " << zeta);
    const auto peak = find_resonance_peak([&](double r) { return viscous(r, zeta); }, grid(0.02, 2.0, 100));
    CHECK_THAT(peak.at, WithinAbs(std::sqrt(1.0 - 2.0 * zeta * zeta), kSolved));
    const double height = 1.0 / (2.0 * zeta * std::sqrt(1.0 - zeta * zeta));
    CHECK_THAT(peak.value / height, WithinAbs(1.0, 1e-12));
    // r^2 = 1 - 2 zeta^2 -+ 2 zeta sqrt(1 - zeta^2)
    const double spread = 2.0 * zeta * std::sqrt(1.0 - zeta * zeta);
    CHECK_THAT(peak.half_power_low, WithinAbs(std::sqrt(1.0 - 2.0 * zeta * zeta - spread), kSolved));
    CHECK_THAT(peak.half_power_high, WithinAbs(std::sqrt(1.0 - 2.0 * zeta * zeta + spread), kSolved));
  }
}

TEST_CASE("a viscous curve has no peak above zeta = 1/sqrt(2), and one just below") {
  for (const double zeta : {0.7072, 0.8, 1.5}) {
    INFO("zeta " << zeta);
    const auto peak = find_resonance_peak([&](double r) { return viscous(r, zeta); }, grid(0.001, 2.0, 500));
    CHECK(std::isnan(peak.at));
    CHECK(std::isnan(peak.value));
    CHECK(std::isnan(peak.half_power_low));
  }
  const auto flat = find_resonance_peak([](double r) { return viscous(r, 0.7); }, grid(0.001, 2.0, 500));
  CHECK_THAT(flat.at, WithinAbs(std::sqrt(0.02), kSolved));
  CHECK(std::isnan(flat.half_power_low));  // the static response is above 1/sqrt(2) of so low a peak
}

TEST_CASE("so flat a peak as that of zeta just below 1/sqrt(2) is met too") {
  for (const double zeta : {0.7, 0.706, 0.70705}) {
    for (const int points : {100, 500}) {
      INFO("zeta " << zeta << " points " << points);
      if (points == 100 && zeta > 0.707) continue;  // the peak lies between the first two places
      const auto peak =
          find_resonance_peak([&](double r) { return viscous(r, zeta); }, grid(0.001, 2.0, points));
      // 1/|X|^2 = const + (r^2 - r_0^2)^2, whose curvature there is 8 r_0^2 of 1: rounding moves the root by
      // that.
      const double resonance = std::sqrt(1.0 - 2.0 * zeta * zeta);
      CHECK_THAT(peak.at, WithinAbs(resonance, 1e-12 / (resonance * resonance)));
      CHECK_THAT(peak.value, WithinAbs(viscous(resonance, zeta), 1e-12));
    }
  }
}

TEST_CASE("a hysteretic peak stands at the natural frequency and is 1/eta high") {
  for (const double eta : {0.002, 0.05, 0.3}) {
    const auto peak =
        find_resonance_peak([&](double r) { return 1.0 / std::hypot(1.0 - r * r, eta); }, grid(0.1, 2.0, 77));
    CHECK_THAT(peak.at, WithinAbs(1.0, kSolved));
    CHECK_THAT(peak.value * eta, WithinAbs(1.0, 1e-12));
    CHECK_THAT(peak.half_power_high, WithinAbs(std::sqrt(1.0 + eta), kSolved));
    CHECK_THAT(peak.half_power_low, WithinAbs(std::sqrt(1.0 - eta), kSolved));
  }
}

TEST_CASE("of two peaks the higher is found, from a grid that runs either way") {
  const auto two = [](double r) { return viscous(r, 0.05) + 2.0 * viscous(r / 1.7, 0.05); };
  std::vector<double> places = grid(0.5, 2.5, 401);
  const auto up = find_resonance_peak(two, places);
  std::reverse(places.begin(), places.end());
  const auto down = find_resonance_peak(two, places);
  CHECK(up.at > 1.6);
  CHECK_THAT(down.at, WithinAbs(up.at, kSolved));
}

TEST_CASE("places without a response are passed over, and a kink is met to the width of the search") {
  const auto broken = [](double r) {
    return r > 1.2 ? std::numeric_limits<double>::quiet_NaN() : viscous(r, 0.05);
  };
  const auto peak = find_resonance_peak(broken, grid(0.1, 2.0, 191));
  CHECK_THAT(peak.at, WithinAbs(std::sqrt(1.0 - 0.005), kSolved));
  const auto kink =
      find_resonance_peak([](double r) { return 2.0 - std::abs(r - 1.03); }, grid(0.1, 2.0, 20));
  CHECK_THAT(kink.at, WithinAbs(1.03, 1e-7));
}

TEST_CASE("a peak far narrower than the grid is met, down to damping ratios of 1e-10") {
  for (const double zeta : {1e-5, 1e-7, 1e-8, 1e-9, 1e-10}) {
    INFO("zeta " << zeta);
    const auto peak = find_resonance_peak([&](double r) { return viscous(r, zeta); }, grid(0.105, 2.0, 97));
    CHECK_THAT(peak.at, WithinAbs(std::sqrt(1.0 - 2.0 * zeta * zeta), 1e-11));
    // 1 - r^2 is known to rounding, 1e-16 beside 2 zeta.
    CHECK_THAT(peak.value * 2.0 * zeta, WithinAbs(1.0, 1e-12 + 1e-15 / zeta));
    CHECK_THAT((peak.half_power_high - peak.half_power_low) / (2.0 * zeta),
               WithinAbs(1.0, 1e-6 + 1e-15 / zeta));
  }
}

TEST_CASE("without damping the peak is unbounded, whether or not the resonance is a place of the grid") {
  const auto undamped = [](double r) { return 1.0 / std::abs(1.0 - r * r); };
  for (const int points : {20, 21}) {
    const auto peak = find_resonance_peak(undamped, grid(0.0, 2.0, points));
    CHECK_THAT(peak.at, WithinAbs(1.0, 1e-11));
    CHECK(std::isinf(peak.value));
    CHECK(std::isnan(peak.half_power_low));
    CHECK(std::isnan(peak.half_power_high));
  }
}

TEST_CASE("a response at one place alone ends the search, as its peak has no width") {
  const auto peak = find_resonance_peak([](double r) { return r == 1.5 ? 1e-47 : 0.0; }, grid(1.0, 2.0, 11));
  CHECK(peak.at == 1.5);
  CHECK(std::isnan(peak.half_power_low));
  CHECK(std::isnan(peak.half_power_high));
}

TEST_CASE("a coarse grid does not choose between two modes of nearly one height") {
  const auto two = [](double r) { return viscous(r, 0.005) + 0.98 * viscous(r / 1.5, 0.005); };
  for (const int points : {11, 21, 41, 101, 1001}) {
    INFO(points << " points");
    CHECK_THAT(find_resonance_peak(two, grid(0.35, 2.2, points)).at, WithinAbs(1.0, 1e-3));
  }
}

}  // namespace
}  // namespace frahm::periodic::resonance_peak_test
