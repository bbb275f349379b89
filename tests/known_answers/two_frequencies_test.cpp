#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"

// Two-frequency forcing: the response without stops of Cheng and Zu, and a case that repeats only with the
// full period.
namespace frahm::periodic::two_frequencies_test {
namespace {

using Catch::Matchers::WithinAbs;
constexpr double kAgreement = 1e-9;  // relative to max(amplitude, 1)

mechanics::Network two_forces(int M, int N) {
  mechanics::Network network = single_mass();
  network.excitations = {{mechanics::ExcitationKind::force, 0, M}, {mechanics::ExcitationKind::force, 0, N}};
  network.reference_order = M;
  return network;
}

mechanics::NetworkValues two_force_values(const TwoFrequencies& s) {
  mechanics::NetworkValues values = single_mass_values(s.r1 / s.M, s.zeta, s.f);
  values.excitation = {{1.0, 0.0}, {s.p2, s.phase}};
  return values;
}

TEST_CASE("Two odd frequencies without stops move the mass as Cheng and Zu say") {
  int checked = 0;
  for (const auto& [M, N] : {std::pair{1, 3}, {3, 1}, {1, 5}, {5, 1}, {3, 5}, {5, 3}}) {
    Responses responses(two_forces(M, N));
    for (const double r1 : {0.5, 0.9, 1.5, 3.0}) {
      for (const double f : {0.02, 0.1, 0.3}) {
        for (const double p2 : {0.2, 1.0, 5.0}) {
          for (const double phase : {0.0, 0.7, 2.5}) {
            const TwoFrequencies system{
                .r1 = r1, .M = M, .N = N, .zeta = 0.1, .f = f, .p2 = p2, .phase = phase};
            const TwoFrequencyResponse exact = two_frequency_response(system);
            if (!exact.valid()) continue;
            responses.solve(two_force_values(system));
            INFO("M " << M << " N " << N << " r1 " << r1 << " f " << f << " p2 " << p2 << " phase " << phase);
            CHECK_THAT(responses["x_amplitude"],
                       WithinAbs(exact.amplitude, kAgreement * std::max(1.0, exact.amplitude)));
            // The minimum half a period later is as large; the earlier of the two is reported.
            const double peak =
                std::remainder(responses["x_peak_phase"] - exact.peak_phase, std::numbers::pi);
            CHECK_THAT(peak, WithinAbs(0.0, kAgreement));
            CHECK(responses["friction_regime"] == static_cast<double>(Regime::non_stop));
            ++checked;
          }
        }
      }
    }
  }
  CHECK(checked > 100);
}

TEST_CASE("Two frequencies of ratio 1/2 have no half-period symmetry and still balance") {
  constexpr double kBalance = 1e-10;
  Responses responses(two_forces(1, 2));
  for (const double r : {0.3, 0.8, 1.7}) {
    for (const double f : {0.05, 0.3, 0.8}) {
      responses.solve(
          two_force_values({.r1 = r, .M = 1, .N = 2, .zeta = 0.05, .f = f, .p2 = 0.6, .phase = 0.9}));
      INFO("r " << r << " f " << f);
      CHECK(responses["status"] == 1.0);
      CHECK(responses["energy_balance"] < kBalance);
      CHECK(responses["floquet_radius"] < 1.0);
      CHECK(std::abs(responses["x_mean"]) > 1e-6);
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::two_frequencies_test
