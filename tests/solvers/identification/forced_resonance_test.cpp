#include "solvers/identification/forced_resonance.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"
#include "tests/solvers/coverage.hpp"

namespace frahm::identification::forced_resonance_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel, Catch::Matchers::Contains;
using std::numbers::pi;
constexpr double kExact = 1e-10;

constexpr double m = 1.0, k = 3022.0;  // [kg], [N/m]: the paper's rig
const double omega = std::sqrt(k / m);
const OneMass known{.mass = m, .stiffness = k};

// Spring and damper on a base, friction to ground.
mechanics::Network on_a_base() {
  using namespace mechanics;
  const Node mass{NodeKind::mass, 0}, base{NodeKind::prescribed, 0};
  return {.masses = {"x"},
          .prescribed = {"base"},
          .elements = {{"spring", ElementType::spring, base, mass},
                       {"damper", ElementType::damper, base, mass},
                       {"friction", ElementType::coulomb, Node{}, mass}},
          .excitations = {{ExcitationKind::motion, 0, 1}}};
}

// The engine's responses at r = 1 to supports, or forces k Y, of Y from 0.6 to 1.6 mm.
ResonancePairs pairs_of(double zeta, double x_f, ResponseTo shaken_by, int count) {
  const bool force = shaken_by == ResponseTo::force;
  periodic::Responses responses(force ? periodic::single_mass() : on_a_base());
  ResonancePairs pairs;
  for (int i = 0; i < count; ++i) {
    const double Y = 0.6e-3 + 1e-3 * i / (count - 1);
    responses.solve({.omega = omega,
                     .mass = {m},
                     .element = {k, 2.0 * zeta * m * omega, k * x_f},
                     .excitation = {{force ? k * Y : Y, 0.0}}});
    pairs.excitation.push_back(Y);
    pairs.response.push_back(responses["x_amplitude"]);
  }
  return pairs;
}

TEST_CASE("The hyperbola gives back damping and friction exactly, to a force and to a support") {
  for (const auto shaken_by : {ResponseTo::force, ResponseTo::support}) {
    for (const double zeta : {0.02, 0.0423, 0.15, 0.5}) {
      for (const double x_f : {0.0, 0.1e-3, 0.2e-3}) {
        INFO("zeta " << zeta << " x_f " << x_f << " support " << (shaken_by == ResponseTo::support));
        const Identification result = forced_resonance(pairs_of(zeta, x_f, shaken_by, 8), shaken_by, known);
        REQUIRE(result.failure == "");
        CHECK_THAT(value_of(result, "damping_ratio"), WithinAbs(zeta, kExact));
        CHECK_THAT(value_of(result, "friction_displacement"), WithinAbs(x_f, kExact * 1e-3));
        CHECK_THAT(value_of(result, "damping"), WithinRel(2.0 * zeta * omega, 1e-8));
        CHECK_THAT(value_of(result, "friction_force"), WithinAbs(k * x_f, kExact * k * 1e-3));
        CHECK(result.notes.empty());
      }
    }
  }
}

// What the line leaves out: H, the support's damper (4 zeta^2 / 2 of the slope), and 1 - s in G.
TEST_CASE("The line gives them to its own linearisation error, of the order of zeta^2 and (H x_f / X)^2") {
  for (const auto shaken_by : {ResponseTo::force, ResponseTo::support}) {
    for (const double zeta : {0.02, 0.0423, 0.1}) {
      const double x_f = 0.2e-3;
      const ResonancePairs pairs = pairs_of(zeta, x_f, shaken_by, 8);
      const double G = periodic::den_hartog_functions(1.0, zeta).G,
                   H = periodic::den_hartog_functions(1.0, zeta).H;
      const double least = *std::min_element(pairs.response.begin(), pairs.response.end()) + G * x_f;
      const double bound = 2.0 * zeta * zeta + 0.5 * std::pow(H * x_f / least, 2);
      const Identification result = forced_resonance(pairs, shaken_by, known);
      INFO("zeta " << zeta << " bound " << bound);
      CHECK_THAT(value_of(result, "damping_ratio_line"), WithinRel(zeta, 2.0 * bound));
      // The intercept is what is left of large numbers: their error counts (X + G x_f) / (G x_f) times.
      const double most = *std::max_element(pairs.response.begin(), pairs.response.end()) + G * x_f;
      CHECK_THAT(value_of(result, "friction_displacement_line"),
                 WithinRel(x_f, 2.0 * bound * most / (G * x_f)));
      CHECK_THAT(value_of(result, "damping_line"),
                 WithinRel(2.0 * value_of(result, "damping_ratio_line") * omega, kExact));
    }
  }
}

TEST_CASE("The paper's slopes and intercepts give its damping and its friction of 1.06 N") {
  const Identification result =
      forced_resonance(ResonanceLines{.slope = {0.08585, 0.083361}, .intercept = {0.3517e-3, 0.544535e-3}},
                       ResponseTo::support, known);
  REQUIRE(result.failure == "");
  CHECK_THAT(value_of(result, "damping_ratio_line"), WithinAbs(0.0423, 5e-5));
  CHECK_THAT(value_of(result, "damping_line"), WithinAbs(4.65, 5e-3));
  CHECK_THAT(value_of(result, "friction_displacement_line"), WithinAbs(0.3514e-3, 5e-8));
  CHECK_THAT(value_of(result, "friction_force_line"), WithinAbs(1.06, 5e-3));
  // As the asymptote of the hyperbola they give hardly more, as zeta^2 is small.
  CHECK_THAT(value_of(result, "damping_ratio"), WithinRel(0.0423, 4.0 * 0.0423 * 0.0423));
  CHECK_THAT(value_of(result, "friction_force"), WithinRel(1.06, 0.01));
  // Two lines have an interval, one has none. t = 12.706 for one degree of freedom.
  const double error = std::abs(0.08585 - 0.083361) / 2.0;
  CHECK_THAT(estimate_of(result, "slope").standard_error, WithinRel(error, kExact));
  CHECK_THAT(estimate_of(result, "slope").high, WithinRel(0.0846055 + 12.7062047 * error, 1e-8));
  const Identification one = forced_resonance(ResonanceLines{.slope = {0.08585}, .intercept = {0.3517e-3}},
                                              ResponseTo::support, known);
  CHECK(one.failure == "");
  CHECK(std::isnan(estimate_of(one, "damping_ratio_line").low));
}

// The hyperbola's asymptote drawn through exact values is the exact one.
TEST_CASE("A line that is the hyperbola's asymptote gives the exact values") {
  const double zeta = 0.2, x_f = 0.3e-3, G = periodic::den_hartog_functions(1.0, zeta).G;
  const double support = 2.0 * zeta / std::sqrt(1.0 + 4.0 * zeta * zeta);
  for (const auto& [slope, shaken_by] :
       {std::pair{2.0 * zeta, ResponseTo::force}, std::pair{support, ResponseTo::support}}) {
    const Identification result =
        forced_resonance(ResonanceLines{.slope = {slope}, .intercept = {slope * G * x_f}}, shaken_by, {});
    REQUIRE(result.failure == "");
    CHECK_THAT(value_of(result, "damping_ratio"), WithinRel(zeta, kExact));
    CHECK_THAT(value_of(result, "friction_displacement"), WithinRel(x_f, kExact));
  }
}

TEST_CASE("Of a hundred noisy sets of pairs the intervals hold the truth in ninety at least") {
  for (const auto shaken_by : {ResponseTo::force, ResponseTo::support}) {
    const double zeta = 0.0423, x_f = 0.2e-3;
    const ResonancePairs exact = pairs_of(zeta, x_f, shaken_by, 12);
    std::vector<Truth> truths{
        {"damping_ratio", zeta}, {"friction_displacement", x_f}, {"friction_force", k * x_f}};
    count_held(truths, [&](unsigned seed) {
      Noise noise(seed);
      return forced_resonance(ResonancePairs{.response = noise.on(exact.response, 2e-5),
                                             .excitation = noise.on(exact.excitation, 5e-6)},
                              shaken_by, known);
    });
    for (const Truth& truth : truths) {
      INFO(truth.name << " held " << truth.held);
      CHECK(truth.held >= kHeld);
    }
  }
}

TEST_CASE("Pairs of a motion that stops are noted, and what tells nothing is refused") {
  // The first of eight amplitudes, 0.6 mm, is too small to keep the mass moving against 0.65 critical ones.
  const double zeta = 0.05, x_f = periodic::critical_friction(1.0, zeta) * 0.65e-3;
  const ResonancePairs pairs = pairs_of(zeta, x_f, ResponseTo::force, 8);
  const Identification stops = forced_resonance(pairs, ResponseTo::force, {});
  REQUIRE(stops.failure == "");
  REQUIRE(stops.notes.size() == 1);
  CHECK_THAT(stops.notes[0], Contains("1 of 8 pairs"));
  const auto refused = [](std::vector<double> response, std::vector<double> excitation) {
    return forced_resonance(ResonancePairs{.response = response, .excitation = excitation},
                            ResponseTo::support, {})
        .failure;
  };
  CHECK_THAT(refused({1.0}, {1.0}), Contains("two pairs"));
  CHECK_THAT(refused({1.0, 1.0}, {1.0, 2.0}), Contains("two pairs"));
  CHECK_THAT(refused({1.0, 2.0}, {2.0, 1.0}), Contains("does not rise"));
  CHECK_THAT(refused({1.0, 2.0, 3.0}, {0.7, 0.7, 0.7 * (1.0 + 1e-15)}), Contains("does not rise"));
  CHECK_THAT(refused({1.0, 2.0}, {1.0, 2.0}), Contains("a slope is 1: a support"));
  CHECK_THAT(refused({1.0, 2.0}, {0.95, 1.9}), Contains("must be below 1"));
  CHECK_THAT(refused({1.0, -2.0}, {2.0, 1.0}), Contains("response 2 of 2 is -2"));
  CHECK_THAT(refused({1.0, 2.0}, {2.0}), Contains("different lengths"));
  CHECK_THAT(
      forced_resonance(ResonanceLines{.slope = {1.2}, .intercept = {0.0}}, ResponseTo::support, {}).failure,
      Contains("a slope is 1.2"));
  CHECK_THAT(
      forced_resonance(ResonanceLines{.slope = {2.2}, .intercept = {0.0}}, ResponseTo::force, {}).failure,
      Contains("must be below 1"));
  CHECK_THAT(forced_resonance(pairs, ResponseTo::force, {.mass = {}, .stiffness = -1.0}).failure,
             Contains("one is -1"));
}

TEST_CASE("Where the response scatters a note says that slope and damping are too small") {
  const ResonancePairs exact = pairs_of(0.0423, 0.2e-3, ResponseTo::support, 12);
  CHECK(forced_resonance(exact, ResponseTo::support, known).notes.empty());
  ResonancePairs loose = exact;
  const double range = exact.response.back() - exact.response.front();
  loose.response = Noise(1).on(loose.response, 0.2 * range);
  for (double& X : loose.response) X = std::max(X, 1e-6);
  const Identification result = forced_resonance(loose, ResponseTo::support, known);
  REQUIRE(result.failure == "");
  REQUIRE(!result.notes.empty());
  CHECK_THAT(result.notes[0], Contains("scatter about the line with R^2 = 0."));
}

}  // namespace
}  // namespace frahm::identification::forced_resonance_test
