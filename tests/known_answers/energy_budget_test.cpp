// What a motion's energy goes into, against closed forms, the periodic responses and the history itself.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "tests/known_answers/free_oscillator.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/rig.hpp"
#include "tests/known_answers/single_mass.hpp"

namespace frahm::transient::energy_budget_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using mechanics::ElementType, mechanics::Node, mechanics::NodeKind;

constexpr double kExact = 1e-12;    // relative to the energy at the start
constexpr double kBalance = 1e-12;  // roundings of some thousand steps

// Every motion: what comes in is what is there at the end and what is lost, all of it shared out.
void check_balance(const EnergyBudget& energy) {
  const double lost = std::accumulate(energy.dissipated.begin(), energy.dissipated.end(), 0.0);
  const double size = std::max({energy.initial, energy.final, lost});
  INFO("start " << energy.initial << " input " << energy.input << " lost " << lost << " end "
                << energy.final);
  CHECK(energy.balance < kBalance);
  CHECK(std::abs(energy.initial + energy.input - energy.final - lost) < 10.0 * kBalance * size);
  CHECK(lost > 0.0);
  for (std::size_t e = 0; e < energy.dissipated.size(); ++e) {
    CHECK(energy.dissipated[e] >= 0.0);
    CHECK_THAT(energy.share[e], WithinAbs(energy.dissipated[e] / lost, 1e-15));
  }
}

// 0.5 m v^2 + 0.5 k x^2 of a release at x_0 = 1 with viscous damping below critical.
double viscous_energy(const FreeOscillator& o, double t) {
  const double w = o.natural_frequency(), w_d = w * o.s(), decay = std::exp(-o.zeta * w * t);
  const double x = decay * (std::cos(w_d * t) + o.zeta / o.s() * std::sin(w_d * t));
  const double v = -decay * w / o.s() * std::sin(w_d * t);
  return 0.5 * (o.m * v * v + o.k * x * x);
}

TEST_CASE("A viscous damper has taken at every time what the closed form has lost") {
  for (const double zeta : {0.003, 0.05, 0.6}) {
    const FreeOscillator oscillator{.m = 2.0, .k = 300.0, .zeta = zeta};
    for (const double periods : {0.13, 3.7, 20.0}) {
      const double duration = periods * 2.0 * oscillator.half_period();
      const FreeDecay decay = free_decay(oscillator.network(), oscillator.values(), {{1.0}, {}},
                                         {.duration = duration, .samples = 57});
      INFO("zeta " << zeta << " periods " << periods);
      check_balance(decay.energy);
      CHECK(decay.energy.initial == 150.0);
      CHECK(decay.energy.input == 0.0);
      CHECK_THAT(decay.energy.final, WithinAbs(viscous_energy(oscillator, duration), 150.0 * kExact));
      for (std::size_t i = 0; i < 57; ++i) {
        const double lost = 150.0 - viscous_energy(oscillator, decay.history.time[i]);
        CHECK_THAT(decay.history.dissipated[1][i], WithinAbs(lost, 150.0 * kExact));
      }
      CHECK(decay.energy.share == std::vector<double>{0.0, 1.0, 0.0});
    }
  }
}

TEST_CASE(
    "Friction takes its force times the way between the turning points, and the spring keeps the rest") {
  for (const double zeta : {0.0, 0.04}) {
    const FreeOscillator oscillator{.m = 3.0, .k = 700.0, .zeta = zeta, .x_f = 0.0037};
    const double x_0 = -0.4837, force = oscillator.k * oscillator.x_f;
    const FreeDecay decay =
        free_decay(oscillator.network(), oscillator.values(), {{x_0}, {}}, {.samples = 3});
    REQUIRE(decay.end == DecayEnd::at_rest);
    const auto points = oscillator.turning_points(x_0, 100000);
    double way = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) way += std::abs(points[i] - points[i - 1]);
    INFO("zeta " << zeta << ", " << points.size() << " turning points");
    check_balance(decay.energy);
    const double start = 0.5 * oscillator.k * x_0 * x_0;
    const double rest = 0.5 * oscillator.k * points.back() * points.back();
    CHECK_THAT(decay.energy.dissipated[2], WithinAbs(force * way, start * kExact));
    CHECK_THAT(decay.energy.dissipated[1], WithinAbs(start - rest - force * way, start * kExact));
    CHECK_THAT(decay.energy.final, WithinAbs(rest, start * kExact));
    CHECK_THAT(decay.history.dissipated[2].back(), WithinAbs(force * way, start * kExact));
  }
}

TEST_CASE("A decay cut short counts until its duration, not until its end is known") {
  const FreeOscillator oscillator{.m = 1.0, .k = 1.0, .x_f = 0.01};
  const FreeDecay decay = free_decay(oscillator.network(), oscillator.values(), {{1.0}, {}},
                                     {.duration = oscillator.half_period()});
  CHECK_THAT(decay.energy.dissipated[2], WithinAbs(0.01 * 1.98, kExact));
  CHECK_THAT(decay.energy.final, WithinAbs(0.5 * 0.98 * 0.98, kExact));
}

TEST_CASE("What never moves dissipates nothing and balances") {
  const FreeOscillator oscillator{.zeta = 0.1, .x_f = 0.2};
  for (const double x_0 : {0.0, 0.15}) {
    const FreeDecay decay = free_decay(oscillator.network(), oscillator.values(), {{x_0}, {}}, {});
    CHECK(decay.energy.dissipated == std::vector<double>(3, 0.0));
    CHECK(decay.energy.share == std::vector<double>(3, 0.0));
    CHECK(decay.energy.initial == 0.5 * x_0 * x_0);
    CHECK(decay.energy.final == decay.energy.initial);
    CHECK(decay.energy.balance == 0.0);
  }
}

// Integral over a history of f(velocities), by Simpson's rule.
template <class Function>
double over_history(const Samples& history, const Function& f) {
  double sum = 0.0;
  const std::size_t last = history.time.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double weight = i == 0 || i == last ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight * f(history.velocity[0][i], history.velocity[1][i]);
  }
  return sum * (history.time[1] - history.time[0]) / 3.0;
}

TEST_CASE("The rig let go shares its energy among dampers and guides as its velocities say") {
  const Node ground{}, main{NodeKind::mass, 0}, tmd{NodeKind::mass, 1};
  const mechanics::Network network{.masses = {"main", "tmd"},
                                   .elements = {{"suspension", ElementType::spring, ground, main},
                                                {"guide_damper", ElementType::damper, ground, main},
                                                {"guide", ElementType::coulomb, ground, main},
                                                {"tmd_spring", ElementType::spring, tmd, main},
                                                {"tmd_damper", ElementType::damper, tmd, main},
                                                {"inerter", ElementType::inerter, tmd, main},
                                                {"tmd_friction", ElementType::coulomb, tmd, main}}};
  const mechanics::NetworkValues values{
      .mass = {102.66, 12.82}, .element = {7.0 * 8181.0, 1.7688, 10.127, 10985.1, 29.57, 6.36, 15.0109}};
  const FreeDecay decay = free_decay(network, values, {{0.03, -0.01}, {0.1, 0.0}}, {.samples = 40001});
  REQUIRE(decay.end == DecayEnd::at_rest);
  check_balance(decay.energy);
  const double start =
      0.5 * (7.0 * 8181.0 * 0.03 * 0.03 + 10985.1 * 0.04 * 0.04 + 102.66 * 0.01 + 6.36 * 0.01);
  CHECK_THAT(decay.energy.initial, WithinRel(start, kExact));
  const auto lost = [&](std::size_t element) { return decay.energy.dissipated[element]; };
  // Samples a few hundred to a period; |v| has a kink at each of some hundred turns.
  constexpr double kSampled = 1e-6;
  const Samples& history = decay.history;
  CHECK_THAT(over_history(history, [](double v, double) { return 1.7688 * v * v; }),
             WithinRel(lost(1), kSampled));
  CHECK_THAT(over_history(history, [](double v, double) { return 10.127 * std::abs(v); }),
             WithinRel(lost(2), kSampled));
  CHECK_THAT(over_history(history, [](double v, double w) { return 29.57 * (v - w) * (v - w); }),
             WithinRel(lost(4), kSampled));
  CHECK_THAT(over_history(history, [](double v, double w) { return 15.0109 * std::abs(v - w); }),
             WithinRel(lost(6), kSampled));
  for (const std::size_t lossless : {0U, 3U, 5U}) CHECK(lost(lossless) == 0.0);
  for (const std::size_t e : {1U, 2U, 4U, 6U}) {
    CHECK_THAT(history.dissipated[e].back(), WithinAbs(lost(e), start * kExact));
    for (std::size_t i = 1; i < history.time.size(); ++i)
      REQUIRE(history.dissipated[e][i] >= history.dissipated[e][i - 1]);
  }
}

mechanics::Network one_mass_on(std::vector<mechanics::Element> elements) {
  return {.masses = {"x"}, .elements = std::move(elements)};
}

TEST_CASE("A hysteretic spring loses what the damper eta k / omega_h loses") {
  const Node ground{}, mass{NodeKind::mass, 0};
  const double m = 2.0, k = 200.0, eta = 0.08, omega_h = 7.0, duration = 3.3;
  const FreeDecay hysteretic =
      free_decay(one_mass_on({{"mount", ElementType::hysteretic, ground, mass}}),
                 {.mass = {m}, .element = {k}, .second = {eta}, .hysteretic_omega = omega_h}, {{0.1}, {}},
                 {.duration = duration});
  check_balance(hysteretic.energy);
  FreeOscillator viscous{.m = m, .k = k};
  viscous.zeta = eta * k / omega_h / (2.0 * std::sqrt(k * m));
  const double lost = 0.01 * (0.5 * k - viscous_energy(viscous, duration));
  CHECK_THAT(hysteretic.energy.dissipated[0], WithinRel(lost, 100.0 * kExact));
}

TEST_CASE("A Maxwell element loses in its damper, and its spring keeps what it holds") {
  const Node ground{}, mass{NodeKind::mass, 0};
  const auto network = one_mass_on({{"spring", ElementType::spring, ground, mass},
                                    {"maxwell", ElementType::maxwell, ground, mass},
                                    {"friction", ElementType::coulomb, ground, mass}});
  for (const auto& [k, c, F] : {std::tuple{40.0, 3.0, 0.0}, {40.0, 3.0, 0.5}, {2.0, 30.0, 3.0}}) {
    const mechanics::NetworkValues values{.mass = {1.0}, .element = {100.0, k, F}, .second = {0.0, c, 0.0}};
    INFO("k " << k << " c " << c << " F " << F);
    const FreeDecay cut = free_decay(network, values, {{0.2}, {1.0}}, {.duration = 0.4, .samples = 2});
    check_balance(cut.energy);
    const double x = cut.history.displacement[0][1], v = cut.history.velocity[0][1];
    const double held = cut.energy.final - 0.5 * (v * v + 100.0 * x * x);
    CHECK(held > 1e-6 * cut.energy.initial);
    const FreeDecay whole = free_decay(network, values, {{0.2}, {1.0}}, {});
    check_balance(whole.energy);
    if (whole.end != DecayEnd::at_rest) continue;
    // Relaxed: nothing but the first spring holds the mass where friction lets it.
    const double rest = whole.masses[0].rest;
    CHECK_THAT(whole.energy.final, WithinAbs(50.0 * rest * rest, kExact * whole.energy.initial));
  }
  // With a spring that hardly gives it is the damper: s = c v but for c^2 v' / k.
  const FreeOscillator oscillator{.m = 1.0, .k = 100.0, .zeta = 0.05};
  const FreeDecay stiff =
      free_decay(network, {.mass = {1.0}, .element = {100.0, 1e4, 0.0}, .second = {0.0, 1.0, 0.0}},
                 {{1.0}, {}}, {.duration = 1.0});
  check_balance(stiff.energy);
  constexpr double kStiff = 1e-3;  // omega c / k
  CHECK_THAT(stiff.energy.dissipated[1], WithinRel(50.0 - viscous_energy(oscillator, 1.0), kStiff));
}

ValuesAt always(const mechanics::NetworkValues& values) {
  return [values](double omega) {
    mechanics::NetworkValues at = values;
    at.omega = omega;
    return at;
  };
}

TEST_CASE("A transient that has become periodic loses in a period what the periodic response does") {
  using periodic::rig, periodic::rig_values;
  const double period = 60.0 / 250.0, omega = 2.0 * std::numbers::pi / period;
  const mechanics::NetworkValues values = rig_values(omega, 6.36, 0.0419);
  periodic::Responses responses(rig());
  responses.solve(values);
  const auto run = [&](double periods) {
    const ForcedMotion motion =
        forced_motion(rig(), always(values), {}, {.from = omega, .duration = periods * period, .samples = 2});
    REQUIRE(motion.failure.empty());
    check_balance(motion.energy);
    return motion;
  };
  const ForcedMotion before = run(400.0), after = run(401.0);
  constexpr double kSettled = 1e-9;  // of the energy in 400 periods, whose last digits are left of one
  for (std::size_t e = 0; e < rig().elements.size(); ++e) {
    const std::string name = rig().elements[e].name;
    if (name != "guide" && name != "tmd_friction" && !name.ends_with("damper")) continue;
    INFO(name);
    CHECK_THAT(after.energy.dissipated[e] - before.energy.dissipated[e],
               WithinRel(responses[name + "_energy"], kSettled));
    CHECK(after.history.dissipated[e].back() == after.energy.dissipated[e]);
  }
  CHECK_THAT(after.energy.input - before.energy.input, WithinRel(responses["energy_input"], kSettled));
}

TEST_CASE("A force at constant frequency and a constant load put in what they work") {
  // x'' + 2 zeta x' + x + f Sgn(x') = cos(t) + 0.3, from rest.
  mechanics::Network network = periodic::single_mass();
  network.excitations.push_back({mechanics::ExcitationKind::force, 0, 0});
  mechanics::NetworkValues values = periodic::single_mass_values(1.0, 0.05, 0.2);
  values.excitation.push_back({0.3, 0.0});
  const ForcedMotion motion =
      forced_motion(network, always(values), {}, {.from = 1.0, .duration = 23.7, .samples = 20001});
  check_balance(motion.energy);
  double work = 0.0;
  const Samples& history = motion.history;
  for (std::size_t i = 0; i + 2 < history.time.size(); i += 2) {
    const auto power = [&](std::size_t j) {
      return (std::cos(history.time[j]) + 0.3) * history.velocity[0][j];
    };
    work += (power(i) + 4.0 * power(i + 1) + power(i + 2)) * (history.time[1] - history.time[0]) / 3.0;
  }
  constexpr double kSampled = 1e-7;  // a kink of the velocity's slope at each turn
  CHECK_THAT(motion.energy.input, WithinRel(work, kSampled));
}

TEST_CASE(
    "A run-up balances: a force that grows, friction, and a hysteretic mount that follows the frequency") {
  const Node ground{}, mass{NodeKind::mass, 0};
  mechanics::Network network = one_mass_on(
      {{"mount", ElementType::hysteretic, ground, mass}, {"guide", ElementType::coulomb, ground, mass}});
  network.excitations = {{mechanics::ExcitationKind::force, 0, 1}};
  const ValuesAt values_at = [](double omega) {
    return mechanics::NetworkValues{.omega = omega,
                                    .mass = {1.0},
                                    .element = {1.0, 0.05},
                                    .excitation = {{0.4 * omega * omega, 0.0}},
                                    .second = {0.1, 0.0}};
  };
  const ForcedMotion motion = forced_motion(
      network, values_at, {}, {.from = 0.3, .run_up = {1.8, 0.03}, .duration = 60.0, .samples = 20001});
  REQUIRE(motion.failure.empty());
  CHECK(motion.stairs > 100);
  check_balance(motion.energy);
  double work = 0.0, rubbed = 0.0;
  const Samples& history = motion.history;
  const double h = history.time[1] - history.time[0];
  for (std::size_t i = 0; i < history.time.size(); ++i) {
    const double t = std::min(history.time[i], 50.0), omega = 0.3 + 0.03 * t;
    const double phase = 0.3 * t + 0.015 * t * t + 1.8 * (history.time[i] - t);
    const double weight = i == 0 || i + 1 == history.time.size() ? 0.5 : 1.0;
    work += weight * h * 0.4 * omega * omega * std::cos(phase) * history.velocity[0][i];
    rubbed += weight * h * 0.05 * std::abs(history.velocity[0][i]);
  }
  constexpr double kStairs = 1e-5;  // the motion is known to about 1e-6 of its peak
  CHECK_THAT(motion.energy.input, WithinRel(work, kStairs));
  CHECK_THAT(motion.energy.dissipated[1], WithinRel(rubbed, kStairs));
}

TEST_CASE(
    "A run-up of a support felt through spring, damper and inerter balances with the work of what drives "
    "it") {
  const double m = 1.0, c = 0.06, k = 1.0, b = 0.5, from = 0.3, alpha = 0.05, to = 1.5;
  const Node mass{NodeKind::mass, 0}, support{NodeKind::prescribed, 0};
  const mechanics::Network network{.masses = {"x"},
                                   .prescribed = {"y"},
                                   .elements = {{"spring", ElementType::spring, support, mass},
                                                {"damper", ElementType::damper, support, mass},
                                                {"inerter", ElementType::inerter, support, mass}},
                                   .excitations = {{mechanics::ExcitationKind::motion, 0, 1}}};
  const mechanics::NetworkValues values{.mass = {m}, .element = {k, c, b}, .excitation = {{1.0, 0.0}}};
  const ForcedMotion motion =
      forced_motion(network, always(values), {{1.0}, {0.0}},
                    {.from = from, .run_up = {to, alpha}, .duration = (to - from) / alpha, .samples = 20001});
  REQUIRE(motion.failure.empty());
  check_balance(motion.energy);
  // The force on the support, all that moves the mass, at the support's velocity y'; y = cos(phi).
  const Samples& history = motion.history;
  const double h = history.time[1] - history.time[0];
  double work = 0.0, damped = 0.0;
  for (std::size_t i = 0; i < history.time.size(); ++i) {
    const double t = history.time[i], phi = from * t + 0.5 * alpha * t * t;
    const double y_1 = -(from + alpha * t) * std::sin(phi), v = history.velocity[0][i];
    const double weight = i == 0 || i + 1 == history.time.size() ? 0.5 : 1.0;
    work -= weight * h * m * -history.acceleration[0][i] * y_1;
    damped += weight * h * c * (v - y_1) * (v - y_1);
  }
  constexpr double kStairs = 1e-5;  // the motion is known to about 1e-6 of its peak
  CHECK_THAT(motion.energy.input, WithinRel(work, kStairs));
  CHECK_THAT(motion.energy.dissipated[1], WithinRel(damped, kStairs));
}

TEST_CASE("Elements that change in a run-up put in what they change of the energy stored") {
  const Node ground{}, mass{NodeKind::mass, 0};
  mechanics::Network network = one_mass_on(
      {{"spring", ElementType::spring, ground, mass}, {"damper", ElementType::damper, ground, mass}});
  network.excitations = {{mechanics::ExcitationKind::force, 0, 1}};
  const ValuesAt stiffening = [](double omega) {
    return mechanics::NetworkValues{
        .omega = omega, .mass = {1.0}, .element = {omega, 0.2}, .excitation = {{0.0, 0.0}}};
  };
  // Without a force: all the work is the spring's, 0.5 k' x^2.
  const ForcedMotion motion =
      forced_motion(network, stiffening, {{1.0}, {}},
                    {.from = 1.0, .run_up = {3.0, 0.2}, .duration = 10.0, .samples = 20001});
  REQUIRE(motion.failure.empty());
  check_balance(motion.energy);
  double work = 0.0;
  const Samples& history = motion.history;
  for (const double x : history.displacement[0])
    work += 0.5 * 0.2 * x * x * (history.time[1] - history.time[0]);
  work -= 0.25 * 0.2 * (history.time[1] - history.time[0]) *
          (std::pow(history.displacement[0].front(), 2) + std::pow(history.displacement[0].back(), 2));
  constexpr double kStairs = 1e-5;
  CHECK_THAT(motion.energy.input, WithinRel(work, kStairs));
}

}  // namespace
}  // namespace frahm::transient::energy_budget_test
