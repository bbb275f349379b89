#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/known_answers/responses.hpp"

// Maxwell elements against their complex stiffness  k i w / (i w + k/c)  (Tschoegl 1989, ch. 3).
namespace frahm::periodic::maxwell_test {
namespace {

using Catch::Matchers::WithinAbs;
using Complex = std::complex<double>;
using mechanics::ElementType, mechanics::ExcitationKind, mechanics::NodeKind;
constexpr double kLinear = 1e-10;

constexpr double kMass = 1.3, kSpring = 2.0, kMaxwellSpring = 3.0, kMaxwellDamper = 0.7;

Complex internal_stiffness(double omega, double k = kMaxwellSpring, double c = kMaxwellDamper) {
  return k * Complex(0.0, omega) / Complex(k / c, omega);
}

// A standard linear solid (Zener): a spring beside a Maxwell element.
mechanics::Network zener(bool shaken) {
  const mechanics::Node base = shaken ? mechanics::Node{NodeKind::prescribed, 0} : mechanics::Node{};
  const mechanics::Node main{NodeKind::mass, 0};
  mechanics::Network network{
      .masses = {"main"},
      .elements = {{"spring", ElementType::spring, base, main}, {"branch", ElementType::maxwell, base, main}},
      .excitations = {{ExcitationKind::force, 0, 1}}};
  if (shaken) {
    network.prescribed = {"base"};
    network.excitations = {{ExcitationKind::motion, 0, 1}};
  }
  return network;
}

mechanics::NetworkValues zener_values(double omega) {
  return {.omega = omega,
          .mass = {kMass},
          .element = {kSpring, kMaxwellSpring},
          .excitation = {{1.0, 0.3}},
          .second = {0.0, kMaxwellDamper}};
}

TEST_CASE("A Zener mount under a force moves as its complex stiffness says") {
  Responses responses(zener(false));
  for (const double omega : {0.01, 0.5, 1.2, 1.5, 3.0, 40.0}) {
    INFO("omega " << omega);
    responses.solve(zener_values(omega));
    const Complex X = std::polar(1.0, 0.3) / (kSpring + internal_stiffness(omega) - kMass * omega * omega);
    CHECK(responses["status"] == 1.0);
    CHECK_THAT(responses["main_peak"] / std::abs(X), WithinAbs(1.0, kLinear));
    CHECK_THAT(responses["main_harmonic"] / std::abs(X), WithinAbs(1.0, kLinear));
    CHECK_THAT(std::remainder(responses["main_phase"] + std::arg(X), 2.0 * std::numbers::pi),
               WithinAbs(0.0, kLinear));
    CHECK_THAT(responses["branch_force_peak"] / std::abs(internal_stiffness(omega) * X),
               WithinAbs(1.0, kLinear));
    // A cycle of amplitude |X| costs pi Im(k) |X|^2.
    CHECK_THAT(
        responses["branch_energy"] / (std::numbers::pi * internal_stiffness(omega).imag() * std::norm(X)),
        WithinAbs(1.0, kLinear));
    CHECK_THAT(responses["branch_energy_share"], WithinAbs(1.0, kLinear));
    CHECK(responses["energy_balance"] < kLinear);
    // The force on the ground: (k + k*) X.
    CHECK_THAT(responses["transmitted_force"] / std::abs((kSpring + internal_stiffness(omega)) * X),
               WithinAbs(1.0, kLinear));
    CHECK_THAT(responses["force_transmissibility"] / std::abs((kSpring + internal_stiffness(omega)) * X),
               WithinAbs(1.0, kLinear));
    CHECK_THAT(responses["main_magnification"] / (kSpring * std::abs(X)), WithinAbs(1.0, kLinear));
  }
}

TEST_CASE("A Zener mount on a moving base passes on what its complex stiffness says") {
  Responses responses(zener(true));
  for (const double omega : {0.01, 0.5, 1.5, 3.0, 40.0}) {
    INFO("omega " << omega);
    responses.solve(zener_values(omega));
    const Complex stiffness = kSpring + internal_stiffness(omega);
    const Complex X = stiffness / (stiffness - kMass * omega * omega);
    CHECK_THAT(responses["main_transmissibility"] / std::abs(X), WithinAbs(1.0, kLinear));
    CHECK_THAT(responses["branch_stroke"] / std::abs(X - 1.0), WithinAbs(1.0, kLinear));
    CHECK_THAT(responses["branch_force_peak"] - std::abs(internal_stiffness(omega) * (X - 1.0)),
               WithinAbs(0.0, kLinear));
    CHECK_THAT(responses["base_transmitted_force"] / std::abs(stiffness * (X - 1.0)),
               WithinAbs(1.0, kLinear));
    CHECK(responses["energy_balance"] < kLinear);
    CHECK(std::isnan(responses["force_transmissibility"]));
  }
}

TEST_CASE("The multipliers of a Zener mount are those of its cubic") {
  Responses responses(zener(false));
  const double omega = 1.1, period = 2.0 * std::numbers::pi / omega;
  responses.solve(zener_values(omega));
  // (m s^2 + k)(s + k1/c1) + k1 s = 0, its real root and its pair by Newton's method from nearby.
  double slowest = -1e9;
  for (Complex s : {Complex(-1.0, 0.0), Complex(-0.1, 1.5)}) {
    for (int i = 0; i < 60; ++i) {
      const Complex rate = kMaxwellSpring / kMaxwellDamper;
      const Complex f = (kMass * s * s + kSpring) * (s + rate) + kMaxwellSpring * s;
      const Complex df = 2.0 * kMass * s * (s + rate) + kMass * s * s + kSpring + kMaxwellSpring;
      s -= f / df;
    }
    slowest = std::max(slowest, s.real());
  }
  CHECK_THAT(responses["floquet_radius"], WithinAbs(std::exp(slowest * period), 1e-9));
}

TEST_CASE("A Maxwell element with a stiff damper is a spring, with a stiff spring a damper") {
  Responses responses(zener(false));
  mechanics::NetworkValues values = zener_values(1.7);
  values.second[1] = 1e8;
  responses.solve(values);
  // relative deviation k1 / (c1 omega)
  CHECK_THAT(responses["main_peak"],
             WithinAbs(1.0 / std::abs(kSpring + kMaxwellSpring - kMass * 1.7 * 1.7), 1e-6));
  values = zener_values(1.7);
  values.element[1] = 2e4;  // deviation of the complex stiffness (c omega)^2 / k1
  responses.solve(values);
  CHECK_THAT(responses["main_peak"],
             WithinAbs(1.0 / std::abs(Complex(kSpring - kMass * 1.7 * 1.7, 1.7 * kMaxwellDamper)), 1e-4));
}

TEST_CASE("A strained Maxwell element bounds a resonance, one that is not strained does not") {
  const mechanics::Node ground{}, a{NodeKind::mass, 0}, b{NodeKind::mass, 1};
  mechanics::Network network{.masses = {"a", "b"},
                             .elements = {{"ka", ElementType::spring, ground, a},
                                          {"kb", ElementType::spring, ground, b},
                                          {"link", ElementType::maxwell, a, b}},
                             .excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::force, 1, 1}}};
  mechanics::NetworkValues values{.omega = 1.0,
                                  .mass = {1.0, 1.0},
                                  .element = {1.0, 1.0, 0.5},
                                  .excitation = {{1.0, 0.0}, {1.0, 0.0}},
                                  .second = {0.0, 0.0, 0.4}};
  Responses responses(network);
  responses.solve(values);  // both masses alike: the link never strains
  CHECK(responses["status"] == static_cast<double>(Status::unbounded));
  values.excitation[1].amplitude = -1.0;  // against each other
  responses.solve(values);
  CHECK(responses["status"] == static_cast<double>(Status::ok));
  // (a - b) k* = P; what both do alike keeps any amplitude at its undamped resonance.
  CHECK_THAT(responses["link_stroke"], WithinAbs(1.0 / std::abs(internal_stiffness(1.0, 0.5, 0.4)), 1e-9));
}

TEST_CASE("Maxwell values must be positive") {
  for (const auto& [stiffness, damping] : {std::pair{0.0, 1.0}, {1.0, 0.0}, {-1.0, 1.0}, {1.0, -1.0}}) {
    mechanics::NetworkValues values = zener_values(1.0);
    values.element[1] = stiffness;
    values.second[1] = damping;
    Responses responses(zener(false));
    CHECK_THROWS_AS(responses.solve(values), mechanics::MechanicsError);
  }
}

}  // namespace
}  // namespace frahm::periodic::maxwell_test
