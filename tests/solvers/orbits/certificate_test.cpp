#include "solvers/orbits/certificate.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"

// Multipliers, contraction and error bound of orbits.
namespace frahm::periodic::certificate_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;

TEST_CASE("The spectral radius is that of the eigenvalues, for rotations, shears and nilpotent matrices") {
  const double c = std::cos(0.3), s = std::sin(0.3);
  Eigen::Matrix3d rotation;
  rotation << 0.9 * c, -0.9 * s, 0.0, 0.9 * s, 0.9 * c, 0.0, 0.0, 0.0, 0.5;
  CHECK_THAT(spectral_radius(rotation), WithinRel(0.9, 1e-12));
  const Eigen::Matrix2d pair = rotation.topLeftCorner<2, 2>();
  CHECK_THAT(spectral_radius(pair), WithinRel(0.9, 1e-14));
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  shear(0, 1) = 1e6;
  CHECK_THAT(spectral_radius(shear), WithinRel(1.0, 1e-8));
  Eigen::Matrix3d nilpotent = Eigen::Matrix3d::Zero();
  nilpotent(0, 1) = nilpotent(1, 2) = 1e3;
  CHECK(spectral_radius(nilpotent) == 0.0);
}

TEST_CASE("Without friction the multipliers are those of the damped oscillator") {
  Responses responses(single_mass());
  for (const double r : {0.3, 1.0, 2.7}) {
    for (const double zeta : {0.01, 0.2}) {
      responses.solve(single_mass_values(r, zeta, 0.0));
      CHECK_THAT(responses["floquet_radius"], WithinRel(std::exp(-2.0 * std::numbers::pi * zeta / r), 1e-12));
    }
  }
}

TEST_CASE("The error bound holds against the closed form of motions without stops") {
  Responses responses(single_mass());
  for (const double zeta : {0.005, 0.05, 0.4}) {
    for (const double r : {0.6, 0.95, 1.4, 2.3}) {
      const double f = 0.5 * critical_friction(r, zeta);
      responses.solve(single_mass_values(r, zeta, f));
      INFO("zeta " << zeta << " r " << r);
      const double off = std::abs(responses["x_peak"] - non_stop_response(r, zeta, f).amplitude);
      CHECK(responses["error_bound"] < 1e-9);
      CHECK(off <= responses["error_bound"] + 1e-13 * responses["x_peak"]);
    }
  }
}

// From an outside search: the bound was 2,700 times too small where a limit of 4e6 N holds two masses
// together.
TEST_CASE("The bound holds where a contact is held far beyond its load") {
  const Node ground{}, a{NodeKind::mass, 0}, b{NodeKind::mass, 1};
  const Network network{.masses = {"a", "b"},
                        .elements = {{"ka", ElementType::spring, ground, a},
                                     {"ca", ElementType::damper, ground, a},
                                     {"kb", ElementType::spring, ground, b},
                                     {"clamp", ElementType::coulomb, a, b}},
                        .excitations = {{ExcitationKind::force, 0, 2}, {ExcitationKind::force, 1, 3}},
                        .reference_order = 2};
  Responses responses(network);
  for (const double limit : {4.0, 4e3, 4e6, 4e9}) {
    responses.solve({.omega = 1.0,
                     .mass = {2.0, 0.7},
                     .element = {2.0, 0.03, 1.0, limit},
                     .excitation = {{0.7, 0.9}, {0.6, 6.0}}});
    // Both masses as one of 2.7 on a spring of 3.
    const auto X = [](int n, double P) { return P / std::complex<double>(3.0 - 2.7 * n * n, 0.03 * n); };
    double peak = 0.0;
    for (int i = 0; i < 2'000'000; ++i) {
      const double t = 2.0 * std::numbers::pi * i / 2e6;
      const auto part = [&](int n, double P, double phase) {
        return (X(n, P) * std::polar(1.0, n * t + phase)).real();
      };
      peak = std::max(peak, std::abs(part(2, 0.7, 0.9) + part(3, 0.6, 6.0)));
    }
    INFO("limit " << limit);
    CHECK(responses["status"] == 1.0);
    CHECK_THAT(responses["a_peak"], WithinAbs(peak, responses["error_bound"] + 1e-11));  // of the samples
    CHECK_THAT(responses["a_mean"], WithinAbs(0.0, responses["error_bound"]));
    CHECK(responses["clamp_stroke"] <= responses["error_bound"]);
  }
}

}  // namespace
}  // namespace frahm::periodic::certificate_test
