#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/known_answers/responses.hpp"

// Hysteretic (structural) damping, k (1 + i eta) at omega_h.
namespace frahm::periodic::hysteretic_test {
namespace {

using namespace mechanics;

constexpr double tolerance = 1e-10;  // relative
const Node ground{}, mass{NodeKind::mass, 0};

Network hysteretic_mass(int order = 1) {
  return {.masses = {"x"},
          .elements = {{"material", ElementType::hysteretic, ground, mass}},
          .excitations = {{ExcitationKind::force, 0, order}},
          .reference_order = order};
}

NetworkValues hysteretic_values(double omega, double eta) {
  return {.omega = omega, .mass = {1.0}, .element = {1.0}, .excitation = {{1.0, 0.0}}, .second = {eta}};
}

TEST_CASE("A hysteretic element's response is 1/(1 - r^2 + i eta) in amplitude, phase, energy and force") {
  Responses responses(hysteretic_mass());
  for (const double eta : {0.02, 0.1, 0.5, 1.0}) {
    for (const double r : {0.01, 0.3, 0.9, 0.999, 1.0, 1.1, 1.5, 3.0}) {
      REQUIRE(responses.solve(hysteretic_values(r, eta)).status == Status::ok);
      const std::complex<double> x = 1.0 / std::complex<double>(1.0 - r * r, eta);
      INFO("eta " << eta << ", r " << r);
      CHECK_THAT(responses["x_amplitude"], Catch::WithinRel(std::abs(x), tolerance));
      CHECK_THAT(responses["x_phase"], Catch::WithinAbs(-std::arg(x), tolerance));
      CHECK_THAT(responses["material_energy"],
                 Catch::WithinRel(std::numbers::pi * eta * std::norm(x), tolerance));
      CHECK_THAT(responses["material_force_peak"],
                 Catch::WithinRel(std::abs(x) * std::sqrt(1.0 + eta * eta), tolerance));
    }
  }
}

TEST_CASE("The hysteretic peak is 1/eta and lies at the natural frequency exactly") {
  Responses responses(hysteretic_mass());
  const auto amplitude = [&](double r, double eta) {
    responses.solve(hysteretic_values(r, eta));
    return responses["x_amplitude"];
  };
  for (const double eta : {0.02, 0.1, 0.5, 1.0}) {
    INFO("eta " << eta);
    const double peak = amplitude(1.0, eta), step = 1e-4;
    CHECK_THAT(peak, Catch::WithinRel(1.0 / eta, 1e-12));
    // (1 - r^2)^2 is symmetric in r^2: equal on both sides of 1, less by (step/eta)^2/2 of the peak.
    const double below = amplitude(std::sqrt(1.0 - step), eta), above = amplitude(std::sqrt(1.0 + step), eta);
    CHECK(below < peak);
    CHECK_THAT(below, Catch::WithinRel(above, 1e-12));
    CHECK_THAT(1.0 - below / peak, Catch::WithinRel(0.5 * std::pow(step / eta, 2), 1e-3));
  }
}

TEST_CASE("The hysteretic phase tends to atan(eta) at low frequency, where a viscous one tends to 0") {
  Responses responses(hysteretic_mass());
  for (const double eta : {0.05, 0.5, 1.0}) {
    for (const double r : {1e-1, 3e-2, 1e-2}) {
      responses.solve(hysteretic_values(r, eta));
      CHECK_THAT(responses["x_phase"], Catch::WithinAbs(std::atan(eta), eta * r * r * 1.1));
    }
  }
}

TEST_CASE("omega_h is the reference order's frequency, unless it is given") {
  Responses third(hysteretic_mass(3));
  third.solve(hysteretic_values(0.3, 0.2));
  CHECK_THAT(third["x_amplitude"], Catch::WithinRel(1.0 / std::hypot(1.0 - 0.81, 0.2), tolerance));

  Responses given(hysteretic_mass());
  NetworkValues values = hysteretic_values(0.5, 0.2);
  values.hysteretic_omega = 2.0;  // eta (omega/omega_h) = 0.05
  given.solve(values);
  CHECK_THAT(given["x_amplitude"], Catch::WithinRel(1.0 / std::hypot(0.75, 0.05), tolerance));
}

TEST_CASE("Along a row of frequencies the hysteretic damper follows the frequency") {
  Responses responses(hysteretic_mass());
  responses.solve(hysteretic_values(0.2, 0.3));
  for (const double r : {0.4, 0.8, 1.2, 1.6}) {
    responses.solve(hysteretic_values(r, 0.3), true);
    INFO("r " << r);
    CHECK_THAT(responses["x_amplitude"], Catch::WithinRel(1.0 / std::hypot(1.0 - r * r, 0.3), tolerance));
  }
}

TEST_CASE("A hysteretic element beside friction is the spring and the damper eta k / omega") {
  Network network = hysteretic_mass(), equal = hysteretic_mass();
  network.elements.push_back({"friction", ElementType::coulomb, ground, mass});
  equal.elements = {{"spring", ElementType::spring, ground, mass},
                    {"damper", ElementType::damper, ground, mass},
                    {"friction", ElementType::coulomb, ground, mass}};
  Responses responses(network), expected(equal);
  for (const double r : {0.3, 0.7, 1.0, 1.4}) {
    NetworkValues values = hysteretic_values(r, 0.2);
    values.element = {1.0, 0.4};
    values.second = {0.2, 0.0};
    responses.solve(values);
    values.element = {1.0, 0.2 / r, 0.4};
    values.second.clear();
    expected.solve(values);
    INFO("r " << r);
    for (const char* name : {"x_amplitude", "x_phase", "friction_stuck_fraction", "transmitted_force"}) {
      INFO(name);
      CHECK_THAT(responses[name], Catch::WithinAbs(expected[name], tolerance));
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::hysteretic_test
