#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/rig.hpp"

// Systems without friction against complex amplitudes.
namespace frahm::periodic::linear_response_test {
namespace {

using namespace mechanics;
using Complex = std::complex<double>;

constexpr double pi = std::numbers::pi;
constexpr double tolerance = 1e-10;  // relative; absolute of angles
const Node ground{}, mass{NodeKind::mass, 0}, base{NodeKind::prescribed, 0};

Network forced() {
  return {.masses = {"x"},
          .elements = {{"spring", ElementType::spring, ground, mass},
                       {"damper", ElementType::damper, ground, mass}},
          .excitations = {{ExcitationKind::force, 0, 1}}};
}

Network on_a_base() {
  return {.masses = {"x"},
          .prescribed = {"base"},
          .elements = {{"spring", ElementType::spring, base, mass},
                       {"damper", ElementType::damper, base, mass},
                       {"inerter", ElementType::inerter, base, mass}},
          .excitations = {{ExcitationKind::motion, 0, 1}}};
}

NetworkValues forced_values(double r, double zeta) {
  return {.omega = r, .mass = {1.0}, .element = {1.0, 2.0 * zeta}, .excitation = {{1.0, 0.0}}};
}

NetworkValues base_values(double r, double zeta, double beta = 0.0) {
  return {.omega = r, .mass = {1.0}, .element = {1.0, 2.0 * zeta, beta}, .excitation = {{1.0, 0.0}}};
}

// The smallest difference of two angles.
double angle_between(double a, double b) {
  return std::abs(std::remainder(a - b, 2.0 * pi));
}

TEST_CASE(
    "Magnification, phase and force transmissibility are the closed forms, from no damping to more than "
    "critical") {
  Responses responses(forced());
  for (const double zeta : {0.0, 0.01, 0.1, 0.5, 1.0, 2.0}) {
    for (const double r : {0.1, 0.5, 0.97, 1.03, std::sqrt(2.0), 2.0, 5.0}) {
      responses.solve(forced_values(r, zeta));
      const Complex x = 1.0 / Complex(1.0 - r * r, 2.0 * zeta * r), force = Complex(1.0, 2.0 * zeta * r) * x;
      INFO("zeta " << zeta << ", r " << r);
      CHECK_THAT(responses["x_amplitude"], Catch::WithinRel(std::abs(x), tolerance));
      CHECK_THAT(responses["x_velocity_peak"], Catch::WithinRel(r * std::abs(x), tolerance));
      CHECK_THAT(responses["x_rms"], Catch::WithinRel(std::abs(x) / std::sqrt(2.0), tolerance));
      CHECK(angle_between(responses["x_phase"], -std::arg(x)) < tolerance);
      CHECK_THAT(responses["transmitted_force"], Catch::WithinRel(std::abs(force), tolerance));
    }
  }
}

TEST_CASE("At resonance the phase is 90 degrees for every damping and the magnification 1/(2 zeta)") {
  Responses responses(forced());
  for (const double zeta : {0.001, 0.01, 0.1, 0.5, 1.0, 2.0}) {
    responses.solve(forced_values(1.0, zeta));
    INFO("zeta " << zeta);
    CHECK_THAT(responses["x_phase"], Catch::WithinAbs(0.5 * pi, tolerance));
    CHECK_THAT(responses["x_amplitude"], Catch::WithinRel(0.5 / zeta, tolerance));
  }
}

TEST_CASE("Transmissibility is 1 at r = sqrt(2) for every damping, and beyond it worse with more") {
  Responses force(forced()), motion(on_a_base());
  for (const double r : {std::sqrt(2.0), 1.5, 3.0, 6.0}) {
    double before = 0.0;
    for (const double zeta : {0.0, 0.05, 0.2, 0.5, 1.0, 2.0}) {
      force.solve(forced_values(r, zeta));
      motion.solve(base_values(r, zeta));
      const double transmitted = force["transmitted_force"];
      INFO("zeta " << zeta << ", r " << r);
      CHECK_THAT(motion["x_amplitude"], Catch::WithinRel(transmitted, tolerance));
      if (zeta == 0.0) CHECK_THAT(transmitted, Catch::WithinRel(1.0 / (r * r - 1.0), tolerance));
      if (r == std::sqrt(2.0)) {
        CHECK_THAT(transmitted, Catch::WithinRel(1.0, tolerance));
      } else {
        CHECK(transmitted > before);
      }
      before = transmitted;
    }
  }
}

TEST_CASE("A base moves its mass through spring, damper and inerter together") {
  Responses responses(on_a_base());
  for (const double beta : {0.0, 0.25, 1.0}) {
    for (const double r : {0.2, 0.8, 1.3, 2.0, 4.0}) {
      responses.solve(base_values(r, 0.07, beta));
      const Complex through(1.0 - beta * r * r, 0.14 * r), x = through / (through - r * r);
      INFO("beta " << beta << ", r " << r);
      CHECK_THAT(responses["x_amplitude"], Catch::WithinRel(std::abs(x), tolerance));
      CHECK(angle_between(responses["x_phase"], -std::arg(x)) < tolerance);
      CHECK_THAT(responses["spring_stroke"], Catch::WithinRel(std::abs(x - 1.0), tolerance));
      CHECK_THAT(responses["base_transmitted_force"], Catch::WithinRel(r * r * std::abs(x), tolerance));
    }
  }
}

TEST_CASE("The rig without friction is its two equations of motion, solved by hand") {
  Responses responses(rig());
  for (const double I : {4.72, 12.9}) {
    for (const double omega : {16.0, 20.0, 23.0, 26.0, 35.0}) {
      responses.solve(rig_values(omega, I, 0.0, 0.0));
      const Complex s(0.0, omega), coupling = I * s * s + (26.5104 + 0.4811 * I) * s + 10985.1;
      const Complex upper = 12.82 * s * s + coupling;
      const Complex lower = 102.66 * s * s + 1.7688 * s + 7.0 * kRigSpring + coupling;
      // [lower, -coupling; -coupling, upper] (x, y) = (K A, 0), by Cramer's rule
      const Complex x = kRigSpring * kRigCrank * upper / (lower * upper - coupling * coupling);
      const Complex y = x * coupling / upper;
      INFO("I " << I << ", omega " << omega);
      CHECK_THAT(responses["main_amplitude"], Catch::WithinRel(std::abs(x), tolerance));
      CHECK_THAT(responses["tmd_amplitude"], Catch::WithinRel(std::abs(y), tolerance));
      CHECK_THAT(responses["tmd_spring_stroke"], Catch::WithinRel(std::abs(x - y), tolerance));
      CHECK(angle_between(responses["main_phase"], 0.5 * pi - std::arg(x)) < tolerance);
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::linear_response_test
