#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "solvers/smooth/friction_curve.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"

// Friction by a curve over the speed: x'' + 2 zeta x' + x + N(x') = cos(r tau).
namespace frahm::periodic::stribeck_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;
constexpr double kRounding = 1e-13;
constexpr double kLinear = 1e-9;      // of a straight curve, relative
constexpr double kIntegrated = 1e-8;  // of the other integration
constexpr double kEnergyBalance = 1e-8;

using Curve = std::vector<CurvePoint>;
const Curve kFalling = {{0.0, 0.0}, {0.05, 0.3}, {0.3, 0.2}, {1.0, 0.15}, {3.0, 0.2}};

Network rubbing_mass() {
  Network network = single_mass();
  network.elements[2].law = ForceLaw::stribeck;
  return network;
}

NetworkValues rubbing_values(double r, double zeta, Curve curve, double P = 1.0) {
  NetworkValues values = single_mass_values(r, zeta, 0.0);
  values.excitation[0].amplitude = P;
  values.smooth = {{}, {}, {.curve = std::move(curve)}};
  return values;
}

TEST_CASE("A curve of friction meets its points, is odd, and stays between them") {
  const smooth::FrictionCurve curve(kFalling);
  for (std::size_t i = 0; i < kFalling.size(); ++i) {
    const auto [speed, force] = kFalling[i];
    CHECK_THAT(curve.at(speed).force, WithinAbs(force, kRounding));
    CHECK_THAT(curve.at(-speed).force, WithinAbs(-force, kRounding));
    CHECK(curve.at(-speed).slope == curve.at(speed).slope);
    const double step = 1e-9;  // the slope is the same on both sides
    CHECK_THAT(curve.at(speed + step).slope, WithinAbs(curve.at(speed - step).slope, 1e-5));
    if (i == 0) continue;
    const double low = std::min(force, kFalling[i - 1].force), high = std::max(force, kFalling[i - 1].force);
    const double width = speed - kFalling[i - 1].speed;
    for (double share = 0.0; share < 1.0; share += 0.01) {
      const double at = kFalling[i - 1].speed + share * width, h = 1e-6 * width;
      CHECK(curve.at(at).force >= low - kRounding);
      CHECK(curve.at(at).force <= high + kRounding);
      if (share == 0.0) continue;
      const double quotient = (curve.at(at + h).force - curve.at(at - h).force) / (2.0 * h);
      CHECK_THAT(curve.at(at).slope, WithinAbs(quotient, 1e-6 * (high - low) / width));
    }
  }
  CHECK(curve.at(7.0).force == 0.2);
  CHECK(curve.at(-7.0).force == -0.2);
  CHECK(curve.at(7.0).slope == 0.0);
}

TEST_CASE("A straight curve is a damper") {
  constexpr double c = 0.2;
  Responses response(rubbing_mass());
  for (const double r : {0.5, 1.0, 1.6}) {
    REQUIRE(response.solve(rubbing_values(r, 0.05, {{0, 0}, {2, 2 * c}, {6, 6 * c}, {9, 9 * c}})).status ==
            Status::ok);
    const double X = 1.0 / std::hypot(1.0 - r * r, (0.1 + c) * r);
    CHECK_THAT(response["x_peak"], WithinRel(X, kLinear));
    CHECK_THAT(response["friction_energy"], WithinRel(std::numbers::pi * c * r * X * X, kLinear));
    CHECK(response["coexisting"] == 1.0);
  }
}

// The classical method of Runge and Kutta with fixed steps, until the motion has settled.
double settled_peak(double r, double zeta, const Curve& points, double P = 1.0) {
  const smooth::FrictionCurve curve(points);
  constexpr int kSteps = 4000, kPeriods = 80;
  const double h = 2.0 * std::numbers::pi / r / kSteps;
  double x = 0.0, v = 0.0, peak = 0.0, before = 0.0;
  const auto acceleration = [&](double t, double at, double speed) {
    return P * std::cos(r * t) - at - 2.0 * zeta * speed - curve.at(speed).force;
  };
  for (int i = 0; i < kSteps * kPeriods; ++i) {
    const double t = i * h;
    const double k1 = acceleration(t, x, v);
    const double k2 = acceleration(t + h / 2, x + h / 2 * v, v + h / 2 * k1);
    const double k3 = acceleration(t + h / 2, x + h / 2 * (v + h / 2 * k1), v + h / 2 * k2);
    const double k4 = acceleration(t + h, x + h * (v + h / 2 * k2), v + h * k3);
    const double x_before = x, v_before = v;
    x += h * v + h * h / 6 * (k1 + k2 + k3);
    v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (i < kSteps * (kPeriods - 1) || v_before * v > 0.0) continue;
    // Hermite's cubic between the two samples, where its velocity vanishes.
    double s = v_before / (v_before - v);
    const double d = (x - x_before) / h;
    const auto rate = [&](double at) {
      return v_before * (1 - 4 * at + 3 * at * at) + v * (3 * at * at - 2 * at) + 6 * d * (at - at * at);
    };
    for (int n = 0; n < 20; ++n) s -= rate(s) * 1e-6 / (rate(s + 1e-6) - rate(s));
    before = x_before + h * (s * v_before * (1 - 2 * s + s * s) + v * (s * s * s - s * s)) +
             (x - x_before) * (3 * s * s - 2 * s * s * s);
    peak = std::max(peak, std::abs(before));
  }
  return peak;
}

TEST_CASE("Under a friction that falls with the speed the peak is that of another integration") {
  Responses response(rubbing_mass());
  for (const double r : {0.6, 0.9, 1.4}) {
    INFO("r " << r);
    const NetworkValues values = rubbing_values(r, 0.1, kFalling);
    const auto summary = response.solve(values);
    INFO(summary.reason);
    CHECK(summary.status == Status::ok);
    CHECK(response["coexisting"] == 1.0);
    CHECK(response["energy_balance"] < kEnergyBalance);
    CHECK_THAT(response["x_peak"], WithinRel(settled_peak(r, 0.1, kFalling), kIntegrated));
  }
}

// The friction takes up to 4 x 0.3/pi of a force at the resonance.
const Curve kSaturating = {{0.0, 0.0}, {0.1, 0.3}, {1.0, 0.3}};

TEST_CASE("A curve that holds a resonance without damping leaves a response, at it and beside it") {
  Responses response(rubbing_mass());
  for (const double r : {0.999, 0.999999, 1.0, 1.001}) {
    INFO("r " << r);
    const auto summary = response.solve(rubbing_values(r, 0.0, kSaturating, 0.05));
    INFO(summary.reason);
    REQUIRE(summary.status == Status::ok);
    CHECK_THAT(response["x_peak"], WithinRel(settled_peak(r, 0.0, kSaturating, 0.05), kIntegrated));
    CHECK(response["energy_balance"] < kEnergyBalance);
  }
}

TEST_CASE(
    "Without damping a resonance is unbounded where the end of a rising curve takes less than the force") {
  const double most = 4.0 * 0.3 / std::numbers::pi;  // at infinite speed
  Responses response(rubbing_mass());
  CHECK(response.solve(rubbing_values(1.0, 0.0, kSaturating, 1.001 * most)).status == Status::unbounded);
  CHECK(response.solve(rubbing_values(1.001, 0.0, kSaturating, 1.001 * most)).status == Status::ok);
  // Slower than the end of its curve it takes less: 0.9 of it at a hundred times the last speed of the rise.
  const auto held = response.solve(rubbing_values(1.0, 0.0, kSaturating, 0.9 * most));
  INFO(held.reason);
  CHECK(held.status == Status::ok);
  CHECK_THAT(response["x_peak"], WithinRel(settled_peak(1.0, 0.0, kSaturating, 0.9 * most), kIntegrated));
}

TEST_CASE(
    "Near a resonance that a rising curve damps far more than the damper every point has its response") {
  const Curve curve = {{0.0, 0.0}, {0.1, 0.3}, {1.0, 0.4}};
  constexpr double zeta = 0.001, P = 0.05;
  Responses response(rubbing_mass());
  for (const double r : {0.9, 0.95, 0.98, 0.99, 1.0, 1.01, 1.02, 1.05, 1.1}) {
    INFO("r " << r);
    const auto summary = response.solve(rubbing_values(r, zeta, curve, P));
    INFO(summary.reason);
    REQUIRE(summary.status == Status::ok);
    CHECK_THAT(response["x_peak"], WithinRel(settled_peak(r, zeta, curve, P), kIntegrated));
  }
}

TEST_CASE("Values of smooth laws that break a rule are refused by name") {
  Responses response(rubbing_mass());
  for (const Curve& curve :
       {Curve{}, Curve{{0.0, 0.1}, {1.0, 0.2}}, Curve{{0, 0}, {1, 1}, {1, 2}}, Curve{{0, 0}, {1, -1}}})
    CHECK_THROWS_WITH(response.solve(rubbing_values(0.9, 0.1, curve)), Catch::Contains("'friction'"));
  Network network = single_mass();
  network.elements[0].law = ForceLaw::cubic;
  CHECK_THROWS_WITH(Responses(network), Catch::Contains("'friction'") && Catch::Contains("exact law"));
}

}  // namespace
}  // namespace frahm::periodic::stribeck_test
