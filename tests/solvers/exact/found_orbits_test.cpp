// What the search for several orbits says of what it found: continua of orbits, mirror pairs, starts that
// settled nowhere.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <vector>

#include "solvers/orbits/orbit.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"

namespace frahm::periodic::found_orbits_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;

constexpr double kClosed = 1e-10;  // of closed forms, relative
// Of figures by a fourth-order Runge-Kutta integration of the same equation, with events by bisection.
constexpr double kIntegrated = 1e-8;

const Node ground{}, first{NodeKind::mass, 0}, second{NodeKind::mass, 1};
constexpr double kOk = 1.0, kGrazing = 2.0, kSeveral = 5.0, kStuck = 5.0;

// Two masses of 1 held together by a joint whose static limit is S; a constant load B, and 0.2 cos(r tau),
// act on the second. Where the joint sticks throughout both are one mass of 2:
//   a(tau) = B + Re 0.2 e^(i r tau) / (1 - 2 r^2 + 0.1 i r).
TEST_CASE("Masses held by static friction under a constant load rest in one position that it can hold") {
  Network network{.masses = {"a", "b"},
                  .elements = {{"ka", ElementType::spring, ground, first},
                               {"kb", ElementType::spring, first, second},
                               {"ca", ElementType::damper, ground, first},
                               {"joint", ElementType::coulomb, first, second}},
                  .excitations = {{ExcitationKind::force, 1, 1}, {ExcitationKind::force, 1, 0}}};
  network.elements[3].has_static_force = true;
  Responses responses(network);
  for (const double S : {1.0, 1.2}) {
    for (const double B : {0.0, 0.5, 1.1, 1.5, 3.0}) {
      for (const double r : {0.5, 1.0}) {
        INFO("S " << S << " B " << B << " r " << r);
        responses.solve({.omega = r,
                         .mass = {1.0, 1.0},
                         .element = {1.0, 1.0, 0.1, 1.0},
                         .excitation = {{0.2, 0.0}, {B, 0.0}},
                         .second = {0.0, 0.0, 0.0, S}});
        CHECK((responses["status"] == kOk || responses["status"] == kGrazing));
        CHECK(responses["joint_regime"] == kStuck);
        CHECK(responses["unsettled"] == 0.0);
        const double swing = 0.2 / std::abs(std::complex<double>(1.0 - 2.0 * r * r, 0.1 * r));
        CHECK_THAT(responses["a_peak"], WithinRel(B + swing, kClosed));
        if (B == 1.5 && r == 0.5) CHECK_THAT(responses["a_peak"], WithinAbs(1.89801488, 5e-9));
      }
    }
  }
}

// The slider never slips from |x| < F/k_t on: it is a spring, and the joint to the first mass sticks.
TEST_CASE("A slider that never slips is counted, and its response is the one without an offset") {
  const Network network = driven_mass({on_the_mass("slider", ElementType::jenkins)});
  Responses responses(network);
  const auto solve = [&](double F) {
    responses.solve({.omega = 0.546,
                     .mass = {0.24},
                     .element = {0.108, 0.088, 0.301},
                     .excitation = {{0.299, 0.0}},
                     .second = {0.0, 0.0, F}});
  };
  solve(0.27);
  CHECK(responses["continuum"] == 1.0);
  const std::complex<double> stiffness(0.409 - 0.24 * 0.546 * 0.546, 0.088 * 0.546);
  CHECK_THAT(responses["x_peak"], WithinRel(0.299 / std::abs(stiffness), kClosed));
  CHECK(responses["error_bound"] < 1e-11);
  solve(0.1);
  CHECK(responses["continuum"] == 0.0);
}

// Of the offsets that the slider's limit allows, -0.12056 to -0.06660, the energy of the mean state falls
// towards the first, where the slider's force just reaches its limit.
TEST_CASE("Of a slider that never slips next to a stop the offset of least energy is shown") {
  const Network network = driven_mass({elastic_stops({-1.0}), on_the_mass("slider", ElementType::jenkins),
                                       on_the_mass("friction", ElementType::coulomb)});
  Responses responses(network);
  responses.solve({.omega = 2.049,
                   .mass = {1.0},
                   .element = {1.0, 0.138, 13.021, 0.282, 0.026},
                   .excitation = {{1.09, 0.0}},
                   .second = {0.0, 0.0, 0.0, 0.133, 0.0},
                   .bends = {{}, {}, {{0.285, 13.021, 0.0}}, {}, {}}});
  CHECK(responses["continuum"] == 1.0);
  CHECK(responses["status"] == kGrazing);
  CHECK_THAT(responses["x_peak"], WithinAbs(0.518283158816, kIntegrated));
  CHECK_THAT(responses["x_amplitude"], WithinAbs(0.434679491893, kIntegrated));
  CHECK_THAT(responses["x_mean"], WithinAbs(0.096279575366, kIntegrated));
  CHECK_THAT(responses["slider_force_peak"], WithinRel(0.133, 1e-8));
}

// 200 random starts, followed over 500 periods with exact flow in pieces: at r = 6 orbits of 3 and of 10
// periods (lowest points -0.196116 and -0.47327), at r = 9 one of 5. At each some of the 8 starts of the
// search are on none of up to 6 periods.
TEST_CASE("Starts whose motions settle on no orbit of the multiples searched are counted") {
  Responses responses(driven_mass({elastic_stops({1.0})}));
  const auto solve = [&](double r) {
    responses.solve({.omega = r,
                     .mass = {1.0},
                     .element = {1.0, 0.04, 100.0},
                     .excitation = {{1.0, 0.0}},
                     .second = {0.0, 0.0, 0.0},
                     .bends = {{}, {}, {{0.0, 100.0, 0.0}}}});
  };
  const double frequencies[] = {5.0, 6.0, 9.0, 11.0}, multiples[] = {6.0, 3.0, 5.0, 6.0},
               unsettled[] = {3.0, 5.0, 6.0, 6.0};
  for (int i = 0; i < 4; ++i) {
    INFO("r " << frequencies[i]);
    solve(frequencies[i]);
    CHECK(responses["period_multiple"] == multiples[i]);
    CHECK(responses["unsettled"] == unsettled[i]);
    CHECK(responses["floquet_radius"] < 1.0);
    if (frequencies[i] == 6.0) CHECK_THAT(responses["x_peak"], WithinAbs(0.1961, 1e-4));
  }
}

// One start leads to one of both, whose motion is from -0.354874840919 to 0.351252539400: figures of a
// Dormand-Prince integration of order 8 from event to event, closed by Newton's method.
TEST_CASE("Of two orbits that are mirror images of each other both are found from one start") {
  Responses responses(driven_mass({elastic_stops({1.0, -1.0})}), {.starts = 1});
  responses.solve({.omega = 1.55,
                   .mass = {1.0},
                   .element = {1.0, 0.1, 20.0},
                   .excitation = {{1.0, 0.0}},
                   .second = {0.0, 0.0, 0.0},
                   .bends = {{}, {}, {{0.2, 20.0, 0.0}, {0.2, 20.0, 0.0}}}});
  CHECK(responses["status"] == kSeveral);
  CHECK(responses["coexisting"] == 2.0);
  CHECK(responses["unsettled"] == 0.0);
  double means[2];
  for (const int which : {0, 1}) {
    responses.tell(which);
    CHECK_THAT(responses["x_peak"], WithinAbs(0.354874840919, kIntegrated));
    CHECK_THAT(responses["x_amplitude"], WithinAbs(0.5 * (0.354874840919 + 0.351252539400), kIntegrated));
    means[which] = responses["x_mean"];
  }
  CHECK(std::abs(means[0]) > 1e-3);
  CHECK_THAT(means[0] + means[1], WithinAbs(0.0, kClosed));
}

}  // namespace
}  // namespace frahm::periodic::found_orbits_test
