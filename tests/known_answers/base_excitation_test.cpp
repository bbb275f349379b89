#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/responses.hpp"

// A moving base: the same mathematics as a force on the mass, but built from other elements.
namespace frahm::periodic::base_excitation_test {
namespace {

using Catch::Matchers::WithinAbs;
using namespace mechanics;
constexpr double kAgreement = 1e-9;  // relative to max(amplitude, 1)

// Spring and damper between base and mass; friction between the mass and `friction_on`.
Network on_a_base(Node friction_on) {
  const Node mass{NodeKind::mass, 0}, base{NodeKind::prescribed, 0};
  return {.masses = {"x"},
          .prescribed = {"base"},
          .elements = {{"spring", ElementType::spring, base, mass},
                       {"damper", ElementType::damper, base, mass},
                       {"friction", ElementType::coulomb, friction_on, mass}},
          .excitations = {{ExcitationKind::motion, 0, 1}}};
}

NetworkValues base_values(double r, double zeta, double f) {
  return {.omega = r, .mass = {1.0}, .element = {1.0, 2.0 * zeta, f}, .excitation = {{1.0, 0.4}}};
}

TEST_CASE("With friction to ground a shaken mass moves as Hundal says") {
  Responses responses(on_a_base(Node{}));
  int checked = 0;
  for (const double r : {0.3, 0.6, 0.95, 1.0, 1.2, 2.0, 5.0}) {
    for (const double zeta : {0.01, 0.1, 0.5, 1.0, 1.3}) {
      for (const double f : {0.05, 0.4, 0.8, 1.1}) {
        const double exact = hundal_amplitude(r, zeta, f);
        if (std::isnan(exact)) continue;
        responses.solve(base_values(r, zeta, f));
        INFO("r " << r << " zeta " << zeta << " f " << f);
        CHECK_THAT(responses["x_amplitude"], WithinAbs(exact, kAgreement * std::max(1.0, exact)));
        ++checked;
      }
    }
  }
  CHECK(checked > 90);
}

TEST_CASE(
    "With friction to the base a shaken mass moves as Levitan says, and rides with the base if f >= r^2") {
  Responses responses(on_a_base(Node{NodeKind::prescribed, 0}));
  int checked = 0;
  for (const double r : {0.5, 0.8, 1.0, 1.2, 2.0, 5.0}) {
    for (const double zeta : {0.01, 0.1, 0.5, 1.0, 1.3}) {
      for (const double f : {0.05, 0.3, 0.6, 0.97, 2.0}) {
        const double exact = levitan_amplitude(r, zeta, f);
        if (std::isnan(exact)) continue;
        responses.solve(base_values(r, zeta, f));
        INFO("r " << r << " zeta " << zeta << " f " << f);
        CHECK_THAT(responses["spring_stroke"], WithinAbs(exact, kAgreement * std::max(1.0, exact)));
        if (exact == 0.0) CHECK(responses["friction_regime"] == static_cast<double>(Regime::stuck));
        ++checked;
      }
    }
  }
  CHECK(checked > 90);
}

}  // namespace
}  // namespace frahm::periodic::base_excitation_test
