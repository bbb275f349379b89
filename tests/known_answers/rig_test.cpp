#include "tests/known_answers/rig.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solvers/orbits/shooting.hpp"
#include "tests/known_answers/responses.hpp"

// The rig of DESIGN section 11 over its working range.
namespace frahm::periodic::rig_test {
namespace {

using Catch::Matchers::WithinAbs;
constexpr double kBalance = 1e-10;
constexpr double kResidual = 1e-12;
constexpr double kSameOrbit = 1e-9;               // relative, in the energy norm
constexpr double kRpm = std::numbers::pi / 30.0;  // [rad/s]

TEST_CASE("Over the rig's working range no point fails, and each balances and is stable") {
  Responses responses(rig());
  double worst_balance = 0.0, worst_residual = 0.0, worst_radius = 0.0;
  int points = 0, failed = 0;
  for (const double I : {4.72, 6.36, 8.81, 12.9}) {
    for (const double share : {0.0, 0.01, 0.0419, 0.1, 0.2, 0.3}) {
      responses.response().begin_row();
      for (double rpm = 150.0; rpm <= 350.0; rpm += 1.0) {
        const mechanics::NetworkValues values = rig_values(rpm * kRpm, I, share);
        if (rpm == 150.0)
          responses.solve(values, true);
        else
          responses.follow(values);
        ++points;
        failed += responses["status"] != 1.0 && responses["status"] != 2.0;
        worst_balance = std::max(worst_balance, responses["energy_balance"]);
        worst_residual = std::max(worst_residual, responses["residual"]);
        worst_radius = std::max(worst_radius, responses["floquet_radius"]);
      }
    }
  }
  INFO("points " << points << ", balance " << worst_balance << ", residual " << worst_residual << ", radius "
                 << worst_radius);
  CHECK(failed == 0);
  CHECK(worst_balance < kBalance);
  CHECK(worst_residual < kResidual);
  CHECK(worst_radius < 1.0);
}

TEST_CASE("Rows followed in frequency agree with points solved from nothing") {
  constexpr double kAgreement = 1e-10;
  Responses warm(rig()), cold(rig());
  for (const double share : {0.0, 0.0419, 0.3}) {
    for (double rpm = 150.0; rpm <= 350.0; rpm += 5.0) {
      const mechanics::NetworkValues values = rig_values(rpm * kRpm, 6.36, share);
      warm.solve(values, true);
      cold.solve(values);
      INFO("rpm " << rpm << " F/P " << share);
      for (const char* name : {"main_amplitude", "tmd_amplitude", "main_mean"}) {
        CHECK(std::abs(warm[name] - cold[name]) < kAgreement * cold["main_peak"]);
      }
      CHECK(warm["guide_stops"] == cold["guide_stops"]);
      CHECK(warm["tmd_friction_regime"] == cold["tmd_friction_regime"]);
    }
  }
}

TEST_CASE("Searches from five far states end on one orbit") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const mechanics::Assembly assembly(rig());
  mechanics::LinearSystem system;
  for (const double rpm : {155.0, 214.0, 250.0, 268.0, 330.0}) {
    for (const double share : {0.0, 0.0419, 0.3}) {
      const mechanics::NetworkValues values = rig_values(rpm * kRpm, 6.36, share);
      assembly.set_values(values, system);
      assembly.set_forcing(values, system);
      Flow<2, 1> flow;
      flow.set_system(system);
      flow.set_forcing(system);
      Shooting<2, 1> shooting(flow);
      Eigen::Vector4d first;
      for (int start = 0; start < 5; ++start) {
        Orbit<2, 1> orbit;
        orbit.half_period = start % 2 == 0;
        const double far = 20.0 * flow.static_norm();
        for (int i = 0; i < 4; ++i) orbit.z[i] = normal(random);
        orbit.z *= far / flow.equations().energy_norm(orbit.z);
        shooting.find(orbit);
        INFO("rpm " << rpm << " F/P " << share << " start " << start << " " << orbit.reason);
        REQUIRE((orbit.status == Status::ok || orbit.status == Status::grazing));
        if (start == 0) first = orbit.z;
        const Eigen::Vector4d difference = orbit.z - first;
        CHECK(flow.equations().energy_norm(difference) < kSameOrbit * flow.equations().energy_norm(first));
      }
    }
  }
}

// The largest amplitude over frequency, by golden sections around the largest of a few samples.
double resonant_peak(double share) {
  Responses responses(rig(false));
  const auto amplitude = [&](double omega) {
    responses.solve(bare_rig_values(omega, share), true);
    return responses["main_amplitude"];
  };
  double lo = 22.0, hi = 25.0;  // natural frequency sqrt(7 * 8181 / 102.66) = 23.62 rad/s
  constexpr double kGolden = 0.6180339887498949;
  double c = hi - kGolden * (hi - lo), d = lo + kGolden * (hi - lo), at_c = amplitude(c), at_d = amplitude(d);
  while (hi - lo > 1e-9) {
    if (at_c > at_d) {
      hi = d, d = c, at_d = at_c, c = hi - kGolden * (hi - lo), at_c = amplitude(c);
    } else {
      lo = c, c = d, at_c = at_d, d = lo + kGolden * (hi - lo), at_d = amplitude(d);
    }
  }
  return std::max(at_c, at_d);
}

TEST_CASE("Without the absorber the resonant peak falls as friction grows") {
  double last = HUGE_VAL;
  for (double share = 0.0; share < 0.85; share += 0.05) {
    const double peak = resonant_peak(share);
    INFO("F/P " << share << " peak " << peak << " m");
    CHECK(peak < last);
    last = peak;
  }
}

TEST_CASE("Friction that clamps the absorber leaves one mass of both, whatever its size") {
  constexpr double kClamped = 1e-10;
  // A second order in the excitation takes the half-period symmetry away.
  mechanics::Network clamped = rig(), joined = rig(false);
  for (mechanics::Network* network : {&clamped, &joined}) {
    network->excitations.push_back({mechanics::ExcitationKind::motion, 0, 2});
  }
  Responses with(clamped), without(joined);
  for (const double friction : {1e4, 1e6, 1e9}) {
    for (const double omega : {8.4, 10.5, 20.0, 26.0}) {
      mechanics::NetworkValues values = rig_values(omega, 4.72, 0.15, friction);
      values.excitation.push_back({0.1 * kRigCrank, 0.3});
      with.solve(values);
      mechanics::NetworkValues one = bare_rig_values(omega, 0.15);
      one.mass[0] += values.mass[1];
      one.excitation = values.excitation;
      without.solve(one);
      INFO("friction " << friction << " omega " << omega << " " << with["status"]);
      CHECK(with["tmd_friction_stuck_fraction"] == 1.0);
      CHECK_THAT(with["main_peak"], WithinAbs(without["main_peak"], kClamped));
      CHECK(with["guide_stops"] == without["guide_stops"]);
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::rig_test
