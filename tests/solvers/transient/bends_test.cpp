#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solvers/laws/damper_bend.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "solvers/laws/spring_bend.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"

// Motions from initial values of elements that bend, and of friction that sticks harder than it slides.
namespace frahm::transient::bends_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;

constexpr double kExact = 1e-11;     // relative, of times and displacements over some periods
constexpr double kBalanced = 1e-10;  // of energies

const Node ground{}, first{NodeKind::mass, 0}, second{NodeKind::mass, 1}, base{NodeKind::prescribed, 0};

mechanics::Element stops(Node a, Node b, bool both) {
  mechanics::Element gap{"stops", ElementType::gap, a, b};
  gap.bends = {{+1.0, &laws::elastic_stop}};
  if (both) gap.bends.push_back({-1.0, &laws::elastic_stop});
  return gap;
}

// The mean time between turning points of the first mass, doubled.
double period_of(const FreeDecay& decay) {
  const auto& extrema = decay.masses[0].extrema;
  REQUIRE(extrema.size() > 4);
  const std::size_t pairs = (extrema.size() - 1) / 2;
  return (extrema[2 * pairs].time - extrema[0].time) / static_cast<double>(pairs);
}

// T = 4 [asin(D/a')/w1 + atan(v1 w2/(w1^2 D))/w2],  v1 = w1 sqrt(a'^2 - D^2),  w2^2 = w1^2 + k/m:
// a' is the amplitude that the inner spring alone would have.
TEST_CASE("A free mass between symmetric stops swings with the period of the two springs") {
  const double m = 1.7, k_inner = 3.0, D = 0.8, k = 11.0;
  Network network;
  network.masses = {"mass"};
  network.elements = {{"spring", ElementType::spring, ground, first}, stops(ground, first, true)};
  for (const double a : {0.81, 1.0, 3.0}) {
    const NetworkValues values{
        .mass = {m}, .element = {k_inner, k}, .bends = {{}, {{D, k, 0.0}, {D, k, 0.0}}}};
    const double w1 = std::sqrt(k_inner / m), w2 = std::sqrt((k_inner + k) / m);
    const double v1 = w1 * std::sqrt(a * a - D * D);
    const double T = 4.0 * (std::asin(D / a) / w1 + std::atan(v1 * w2 / (w1 * w1 * D)) / w2);
    const FreeDecay decay = free_decay(network, values, {{}, {w1 * a}}, {.duration = 20.0 * T});
    CHECK_THAT(period_of(decay), WithinRel(T, kExact));
    CHECK(decay.energy.balance < kBalanced);
    // Energy at a turning point: k_inner x^2/2 + k (x - D)^2/2.
    const double x = std::abs(decay.masses[0].extrema.back().displacement), past = x - D;
    CHECK_THAT(0.5 * (k_inner * x * x + k * past * past), WithinRel(0.5 * k_inner * a * a, 10.0 * kExact));
  }
}

TEST_CASE("The touches of stops are told with their times, each side by itself") {
  const double m = 1.7, k_inner = 3.0, D = 0.8, k = 11.0, a = 1.3;
  Network network;
  network.masses = {"mass"};
  network.elements = {{"spring", ElementType::spring, ground, first}, stops(ground, first, true)};
  network.excitations = {{ExcitationKind::force, 0, 0}};
  const NetworkValues values{.omega = 1.0,
                             .mass = {m},
                             .element = {k_inner, k},
                             .excitation = {{0.0, 0.0}},
                             .bends = {{}, {{D, k, 0.0}, {D, k, 0.0}}}};
  const double w1 = std::sqrt(k_inner / m), w2 = std::sqrt((k_inner + k) / m);
  const double v1 = w1 * std::sqrt(a * a - D * D);
  const double free = 2.0 * std::asin(D / a) / w1, touch = 2.0 * std::atan(v1 * w2 / (w1 * w1 * D)) / w2;
  const ForcedMotion motion = forced_motion(network, [&](double) { return values; }, {{}, {w1 * a}},
                                            {.from = 1.0, .duration = 10.0 * (free + touch)});
  REQUIRE(motion.touches.size() == 2);
  for (std::size_t side = 0; side < 2; ++side) {
    REQUIRE(motion.touches[side].size() == 5);
    for (std::size_t i = 0; i < 5; ++i) {
      const double onset = 0.5 * free + static_cast<double>(2 * i + side) * (free + touch);
      CHECK_THAT(motion.touches[side][i].onset, WithinRel(onset, kExact));
      CHECK_THAT(motion.touches[side][i].end, WithinRel(onset + touch, kExact));
    }
  }
}

TEST_CASE("A free mass with a stop on one side, without clearance, swings at 2 w1 w2/(w1 + w2)") {
  const double m = 0.6, k_inner = 2.0, k = 5.0;
  Network network;
  network.masses = {"mass"};
  network.elements = {{"spring", ElementType::spring, ground, first}, stops(ground, first, false)};
  const NetworkValues values{.mass = {m}, .element = {k_inner, k}, .bends = {{}, {{0.0, k, 0.0}}}};
  const double w1 = std::sqrt(k_inner / m), w2 = std::sqrt((k_inner + k) / m);
  const double T = std::numbers::pi * (w1 + w2) / (w1 * w2);
  for (const double x_0 : {1.0, -1.0}) {
    const FreeDecay decay = free_decay(network, values, {{x_0}, {}}, {.duration = 20.0 * T});
    CHECK_THAT(period_of(decay), WithinRel(T, kExact));
    CHECK(decay.energy.balance < kBalanced);
  }
}

// With a load P the mass rests on the stop at k_inner u + k (u - D) = P.
TEST_CASE("A mass that its load presses on a damped stop bounces until it rests there") {
  const double k_inner = 1.0, k = 20.0, c = 0.6, D = 0.5, P = 2.0;
  Network network;
  network.masses = {"mass"};
  network.elements = {{"spring", ElementType::spring, ground, first},
                      {"damper", ElementType::damper, ground, first},
                      stops(ground, first, false)};
  network.excitations = {{ExcitationKind::force, 0, 0}};
  const NetworkValues values{.omega = 1.0,
                             .mass = {1.0},
                             .element = {k_inner, 0.05, k},
                             .excitation = {{P, 0.0}},
                             .second = {0.0, 0.0, c},
                             .bends = {{}, {}, {{D, k, c}}}};
  const ForcedMotion motion = forced_motion(network, [&](double) { return values; }, {{-1.0}, {}},
                                            {.from = 1.0, .duration = 60.0, .samples = 400});
  REQUIRE(motion.failure.empty());
  CHECK_THAT(motion.history.displacement[0].back(), WithinRel((P + k * D) / (k_inner + k), 1e-8));
  CHECK(motion.energy.balance < kBalanced);
  // What the stop has dissipated never falls: where it lets go it gives up what it has stored.
  const std::vector<double>& lost = motion.history.dissipated[2];
  CHECK(std::is_sorted(lost.begin(), lost.end()));
  CHECK(lost.back() > 0.1 * motion.energy.initial);
}

TEST_CASE("A spring with a table softens or hardens a free mass's swing, whose energy stays") {
  Network network;
  network.masses = {"mass"};
  network.elements = {{"spring", ElementType::spring, ground, first}};
  network.elements[0].bends = {{+1.0, &laws::spring_bend}, {-1.0, &laws::spring_bend}};
  // Softer to the right of 0.3, harder to the left of -0.2.
  const NetworkValues values{.mass = {1.0}, .element = {4.0}, .bends = {{{0.3, -3.0, 0.0}, {0.2, 5.0, 0.0}}}};
  const FreeDecay decay = free_decay(network, values, {{1.0}, {}}, {.duration = 50.0});
  CHECK(decay.energy.balance < kBalanced);
  const double energy = 0.5 * 4.0 - 0.5 * 3.0 * 0.7 * 0.7;
  CHECK_THAT(decay.energy.initial, WithinRel(energy, kExact));
  // 4 x^2/2 + 5 (x - 0.2)^2/2 = energy on the other side
  const double x = (1.0 + std::sqrt(1.0 - 9.0 * (0.2 - 2.0 * energy))) / 9.0;
  CHECK_THAT(decay.masses[0].extrema[1].displacement, WithinRel(-x, kExact));
}

TEST_CASE("The energy budget of a shaken absorber with stops, tables and static friction is closed") {
  Network network;
  network.masses = {"main", "absorber"};
  network.prescribed = {"base"};
  network.elements = {{"foot", ElementType::spring, base, first},
                      {"foot_damper", ElementType::damper, base, first},
                      {"absorber_spring", ElementType::spring, first, second},
                      stops(first, second, true),
                      stops(base, first, false),
                      {"guide", ElementType::coulomb, first, second}};
  network.elements[1].bends = {{+1.0, &laws::damper_bend}, {-1.0, &laws::damper_bend}};
  network.elements[5].has_static_force = true;
  network.excitations = {{ExcitationKind::motion, 0, 1}};
  const NetworkValues values{.omega = 0.93,
                             .mass = {1.0, 0.1},
                             .element = {1.0, 0.05, 0.09, 0.3, 1.0, 0.01},
                             .excitation = {{0.3, 0.4}},
                             .second = {0.0, 0.0, 0.0, 0.02, 0.1, 0.012},
                             .bends = {{},
                                       {{0.1, 0.0, -0.02}, {0.2, 0.0, 0.1}},
                                       {},
                                       {{0.6, 0.3, 0.02}, {0.7, 0.2, 0.03}},
                                       {{0.3, 1.0, 0.1}},
                                       {}}};
  const ForcedMotion motion =
      forced_motion(network, [&](double) { return values; }, {}, {.from = 0.93, .duration = 200.0});
  REQUIRE(motion.failure.empty());
  CHECK(motion.energy.balance < kBalanced);
  for (const std::size_t e : {1, 3, 4, 5}) CHECK(motion.energy.dissipated[e] > 0.0);
  CHECK(motion.energy.dissipated[2] == 0.0);
}

// It starts at rest at x_0 with F < k x_0 <= F_s: it stays; beyond F_s it slides with F.
TEST_CASE("A mass that sticks harder than it slides is let go by its static limit alone") {
  const double k = 2.0, F = 0.3, F_s = 0.7;
  Network network;
  network.masses = {"mass"};
  network.elements = {{"spring", ElementType::spring, ground, first},
                      {"friction", ElementType::coulomb, ground, first}};
  network.elements[1].has_static_force = true;
  const NetworkValues values{.mass = {1.0}, .element = {k, F}, .second = {0.0, F_s}};
  CHECK(free_decay(network, values, {{0.99 * F_s / k}, {}}, {}).stop_time == 0.0);
  // |x| falls by 2 F/k each half swing, until it is at most F_s/k.
  double x = 1.01 * F_s / k;
  int turns = 0;
  for (; std::abs(x) > F_s / k; ++turns) x = -x + std::copysign(2.0 * F / k, x);
  const FreeDecay decay = free_decay(network, values, {{1.01 * F_s / k}, {}}, {});
  CHECK(decay.end == DecayEnd::at_rest);
  CHECK_THAT(decay.masses[0].rest, WithinAbs(x, kExact));
  CHECK_THAT(decay.stop_time, WithinRel(turns * std::numbers::pi / std::sqrt(k), kExact));
  CHECK(decay.energy.balance < kBalanced);
}

}  // namespace
}  // namespace frahm::transient::bends_test
