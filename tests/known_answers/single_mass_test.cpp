#include "tests/known_answers/single_mass.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/responses.hpp"

// The general path on one mass, against the closed forms.
namespace frahm::periodic::single_mass_test {
namespace {

using Catch::Matchers::WithinAbs;
using std::numbers::pi;

constexpr double kAgreement = 1e-9;         // of amplitude and phase, relative to max(amplitude, 1)
constexpr double kCriticalFriction = 1e-8;  // of f_crit
constexpr double kMultiplier = 1e-9;
constexpr double kBalance = 1e-10;

double angle_between(double a, double b) {
  return std::abs(std::remainder(a - b, 2.0 * pi));
}

bool is_regime(const Responses& responses, Regime regime) {
  return responses["friction_regime"] == static_cast<double>(regime);
}

TEST_CASE("Without stops, amplitude and phase are Den Hartog's over the (r, zeta, f) space") {
  Responses cold(single_mass()), warm(single_mass());
  double worst_amplitude = 0.0, worst_phase = 0.0, worst_warm = 0.0;
  int points = 0;
  for (const double zeta : {0.001, 0.02, 0.1, 0.5, 0.999, 1.0, 1.2, 3.0}) {
    for (const double share : {0.05, 0.5, 0.95}) {
      warm.response().forget();
      for (double r = 0.12; r < 4.0; r *= 1.05) {
        const double f = share * critical_friction(r, zeta);
        const ClosedForm exact = non_stop_response(r, zeta, f);
        const mechanics::NetworkValues values = single_mass_values(r, zeta, f);
        cold.solve(values);
        warm.solve(values, true);
        INFO("r " << r << " zeta " << zeta << " f " << f);
        CHECK(is_regime(cold, Regime::non_stop));
        const double size = std::max(1.0, exact.amplitude);
        worst_amplitude = std::max(worst_amplitude, std::abs(cold["x_amplitude"] - exact.amplitude) / size);
        worst_warm = std::max(worst_warm, std::abs(warm["x_amplitude"] - exact.amplitude) / size);
        // The velocity is flat about the maximum, the position of a maximum is as steep as the acceleration
        // there.
        const double phase_error = std::min(angle_between(cold["x_peak_phase"], exact.peak_lag),
                                            angle_between(cold["x_peak_phase"], exact.peak_lag + pi));
        worst_phase = std::max(worst_phase, phase_error);
        CHECK(cold["status"] == 1.0);
        CHECK(cold["energy_balance"] < kBalance);
        ++points;
      }
    }
  }
  INFO("points " << points << ", worst amplitude " << worst_amplitude << ", warm " << worst_warm << ", phase "
                 << worst_phase);
  CHECK(worst_amplitude < kAgreement);
  CHECK(worst_warm < kAgreement);
  CHECK(worst_phase < kAgreement);
}

TEST_CASE(
    "The border of the region without stops is f_crit, also where its supremum lies inside the half cycle") {
  Responses responses(single_mass());
  for (const double r : {0.12, 0.2, 0.3, 0.39, 0.49, 0.55, 0.8, 1.0, 1.4, 2.2, 3.5}) {
    for (const double zeta : {0.02, 0.3}) {
      const double exact = critical_friction(r, zeta);
      double without_stops = 0.5 * exact, with_stops = std::min(1.5 * exact, 0.999);
      while (with_stops - without_stops > 1e-10) {
        const double f = 0.5 * (without_stops + with_stops);
        responses.solve(single_mass_values(r, zeta, f));
        (is_regime(responses, Regime::non_stop) ? without_stops : with_stops) = f;
      }
      INFO("r " << r << " zeta " << zeta);
      CHECK_THAT(without_stops, WithinAbs(exact, kCriticalFriction));
    }
  }
}

TEST_CASE("With one stop a half cycle the amplitude solves the two equations of that orbit") {
  Responses responses(single_mass());
  double worst = 0.0;
  int points = 0;
  for (const double zeta : {0.0, 0.01, 0.1, 0.6, 1.0, 1.4}) {
    for (double r = 0.2; r < 3.0; r *= 1.1) {
      for (const double f : {0.3, 0.6, 0.8, 0.9, 0.99}) {
        if (f <= critical_friction(r, zeta)) continue;
        const OneStop exact = one_stop_response(r, zeta, f);
        if (!exact.valid()) continue;
        responses.solve(single_mass_values(r, zeta, f));
        INFO("r " << r << " zeta " << zeta << " f " << f << " X " << exact.amplitude);
        CHECK(is_regime(responses, Regime::one_stop));
        CHECK(responses["friction_stops"] == 2.0);
        CHECK(responses["friction_reversals"] == 2.0);
        const double stuck = 1.0 - exact.sliding_time * r / pi;
        CHECK_THAT(responses["friction_stuck_fraction"], WithinAbs(stuck, 1e-7));
        worst = std::max(worst, std::abs(responses["x_amplitude"] - exact.amplitude));
        CHECK(responses["energy_balance"] < kBalance);
        ++points;
      }
    }
  }
  INFO("worst " << worst);
  CHECK(worst < kAgreement);
  CHECK(points > 300);
}

TEST_CASE("Floquet multipliers are those of the closed forms") {
  Responses responses(single_mass());
  for (const double zeta : {0.0, 0.01, 0.1, 1.0, 1.3}) {
    for (const double r : {0.3, 0.45, 0.7, 0.95, 1.2, 2.0, 3.1}) {
      const double f_crit = critical_friction(r, zeta);
      for (const double f : {0.3 * f_crit, 0.9 * f_crit, 1.1 * f_crit, 0.9}) {
        const bool non_stop = f <= f_crit;
        if (!non_stop && !one_stop_response(r, zeta, f).valid()) continue;
        const auto multipliers =
            non_stop ? non_stop_multipliers(r, zeta, f) : one_stop_multipliers(r, zeta, f);
        const double radius = std::max(std::abs(multipliers[0]), std::abs(multipliers[1]));
        responses.solve(single_mass_values(r, zeta, f));
        INFO("r " << r << " zeta " << zeta << " f " << f);
        CHECK_THAT(responses["floquet_radius"], WithinAbs(radius, kMultiplier));
      }
    }
  }
}

TEST_CASE("Critical and strong damping are as exact as any other") {
  Responses responses(single_mass());
  for (const double zeta : {1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.2}) {
    for (const double r : {0.3, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 2.0}) {
      for (const double f : {0.05, 0.3, 0.7, 0.9, 0.99}) {
        responses.solve(single_mass_values(r, zeta, f));
        const double exact = classical_amplitude(r, zeta, f);
        INFO("r " << r << " zeta " << zeta << " f " << f);
        REQUIRE(std::isfinite(exact));
        CHECK_THAT(responses["x_amplitude"], WithinAbs(exact, kAgreement));
      }
    }
  }
}

TEST_CASE("Undamped at resonance the response is unbounded up to F/P = pi/4 and known beyond") {
  Responses responses(single_mass());
  for (const double f : {0.0, 0.5, pi / 4.0 - 1e-9}) {
    responses.solve(single_mass_values(1.0, 0.0, f));
    INFO("f " << f);
    CHECK(responses["status"] == 3.0);
    CHECK(std::isnan(responses["x_amplitude"]));
    CHECK(responses["friction_stops"] == -1.0);
    CHECK(responses["friction_regime"] == 0.0);
  }
  for (const double f : {0.79, 0.9}) {
    for (const double r : {1.0 - 1e-9, 1.0, 1.0 + 1e-9}) {
      responses.solve(single_mass_values(r, 0.0, f));
      INFO("f " << f << " r - 1 " << r - 1.0);
      CHECK((responses["status"] == 1.0 || responses["status"] == 2.0));
      CHECK_THAT(responses["x_amplitude"], WithinAbs(one_stop_response(r, 0.0, f).amplitude, kAgreement));
    }
  }
  // A hair off resonance it is bounded, however large: Den Hartog's formula.
  for (const double r : {1.0 - 1e-9, 1.0 + 1e-9}) {
    responses.solve(single_mass_values(r, 0.0, 0.5));
    const double exact = non_stop_response(r, 0.0, 0.5).amplitude;
    INFO("r - 1 " << r - 1.0 << " exact " << exact << " got " << responses["x_amplitude"]);
    CHECK(responses["status"] != 3.0);
  }
}

TEST_CASE("Undamped at resonance a guess from the neighbours leads to no other response than none does") {
  Responses warm(single_mass());
  for (int i = 0; i <= 120; ++i) {
    const double f = 0.01 * i;
    warm.response().begin_row();
    for (int k = 0; k <= 10; ++k) {
      const double r = 0.5 + 0.05 * k;  // the last one at resonance
      warm.solve(single_mass_values(r, 0.0, f), true);
    }
    if (f < pi / 4.0 || f >= 1.0) continue;
    INFO("f " << f);
    CHECK_THAT(warm["x_amplitude"], WithinAbs(one_stop_response(1.0, 0.0, f).amplitude, kAgreement));
  }
}

TEST_CASE("Friction as large as the force holds the mass for ever") {
  Responses responses(single_mass());
  for (const double f : {1.0, 1.0 + 1e-12, 1.5, 100.0}) {
    for (const double zeta : {0.0, 0.05, 1.0}) {
      for (const double r : {0.1, 1.0, 2.7}) {
        responses.solve(single_mass_values(r, zeta, f));
        INFO("f " << f << " zeta " << zeta << " r " << r);
        CHECK((responses["status"] == 1.0 || responses["status"] == 2.0));
        CHECK(is_regime(responses, Regime::stuck));
        CHECK_THAT(responses["x_amplitude"], WithinAbs(0.0, kAgreement));
        CHECK_THAT(responses["x_mean"], WithinAbs(0.0, kAgreement));
        CHECK(responses["friction_stops"] == 0.0);
        CHECK(responses["friction_stuck_fraction"] == 1.0);
        CHECK_THAT(responses["floquet_radius"], WithinAbs(0.0, kMultiplier));
        CHECK_THAT(responses["friction_force_peak"], WithinAbs(1.0, 1e-12));
      }
    }
  }
}

TEST_CASE("Without friction the response is the linear one") {
  Responses responses(single_mass());
  for (const double zeta : {0.0, 1e-4, 0.3, 1.0}) {
    for (const double r : {0.05, 0.7, 1.1, 5.0, 40.0}) {
      responses.solve(single_mass_values(r, zeta, 0.0));
      const double V = den_hartog_functions(r, zeta).V;
      INFO("r " << r << " zeta " << zeta);
      CHECK_THAT(responses["x_amplitude"], WithinAbs(V, kAgreement * std::max(1.0, V)));
      CHECK(is_regime(responses, Regime::no_friction));
      CHECK_THAT(responses["x_phase"], WithinAbs(std::atan2(2.0 * zeta * r, 1.0 - r * r), kAgreement));
      CHECK_THAT(responses["x_rms"], WithinAbs(V / std::sqrt(2.0), kAgreement * std::max(1.0, V)));
      CHECK_THAT(responses["x_velocity_peak"], WithinAbs(r * V, kAgreement * std::max(1.0, r * V)));
      CHECK_THAT(responses["x_acceleration_peak"],
                 WithinAbs(r * r * V, kAgreement * std::max(1.0, r * r * V)));
    }
  }
}

TEST_CASE("Where Den Hartog's formula misleads, the orbit is the true one") {
  Responses responses(single_mass());
  responses.solve(single_mass_values(0.2, 0.05, 0.2));
  CHECK_THAT(responses["x_amplitude"], WithinAbs(0.918, 5e-4));
  CHECK_THAT(responses["x_amplitude"], WithinAbs(one_stop_response(0.2, 0.05, 0.2).amplitude, kAgreement));
}

}  // namespace
}  // namespace frahm::periodic::single_mass_test
