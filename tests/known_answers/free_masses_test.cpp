// Masses that no spring holds: motions in closed form, and drawn at random against an independent
// integration.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/free_directions.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "tests/known_answers/exponential_integrator.hpp"
#include "tests/known_answers/random_free_network.hpp"
#include "tests/known_answers/single_mass.hpp"

namespace frahm::transient::free_masses_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel, Catch::Matchers::Contains;
using mechanics::Element, mechanics::ElementType, mechanics::Excitation, mechanics::ExcitationKind;
using mechanics::FreeMasses, mechanics::Network, mechanics::NetworkValues, mechanics::Node,
    mechanics::NodeKind;
using periodic::on_the_mass;

constexpr double kExact = 1e-13;  // relative
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr Node kGround{}, kFirst{NodeKind::mass, 0}, kSecond{NodeKind::mass, 1};

// One mass on friction alone.
Network sliding_block() {
  return {.masses = {"x"}, .elements = {on_the_mass("friction", ElementType::coulomb)}};
}

// Two masses that an element joins, and nothing else.
Network pair_with(std::vector<Element> elements) {
  return {.masses = {"a", "b"}, .elements = std::move(elements)};
}

ForcedMotion motion_of(const Network& network, const NetworkValues& values, const InitialState& initial,
                       const ForcedOptions& options) {
  return forced_motion(
      network,
      [&](double omega) {
        NetworkValues here = values;
        here.omega = omega;
        return here;
      },
      initial, options);
}

TEST_CASE("A block slides to rest in v m/F, v^2 m/(2 F) away, whatever the scale of time") {
  for (const double F : {3.0, 3e-12, 3e12}) {
    for (const double duration : {0.0, 0.4, 10.0}) {  // of the time to the stop
      const double m = 2.0, v = 1.5, stop = v * m / F;
      const FreeDecay decay = free_decay(sliding_block(), {.mass = {m}, .element = {F}}, {{0.0}, {v}},
                                         {.duration = duration * stop, .samples = 11});
      INFO("F " << F << ", duration " << duration << " " << decay.reason);
      CHECK(decay.end == DecayEnd::at_rest);
      CHECK(decay.energy.balance < kExact);
      CHECK(std::isnan(decay.hysteretic_omega));
      CHECK(decay.masses[0].drift == 0.0);
      CHECK_THAT(decay.masses[0].rest, WithinRel(0.5 * v * stop, kExact));
      if (duration == 0.4) {
        CHECK(std::isnan(decay.stop_time));
        CHECK_THAT(decay.history.displacement[0].back(), WithinRel(0.5 * v * stop * (1.0 - 0.36), kExact));
      } else {
        CHECK_THAT(decay.stop_time, WithinRel(stop, kExact));
        CHECK_THAT(decay.history.displacement[0].back(), WithinRel(0.5 * v * stop, kExact));
      }
    }
  }
}

TEST_CASE("A mass on a damper tends to m v/c") {
  const double m = 2.0, c = 0.3, v = 1.5;
  const Network network{.masses = {"x"}, .elements = {on_the_mass("damper", ElementType::damper)}};
  const FreeDecay decay =
      free_decay(network, {.mass = {m}, .element = {c}}, {{0.4}, {v}}, {.duration = 3.0, .samples = 2});
  CHECK_THAT(decay.history.displacement[0].back(),
             WithinRel(0.4 + m * v / c * (1.0 - std::exp(-3.0 * c / m)), kExact));
  const FreeDecay whole = free_decay(network, {.mass = {m}, .element = {c}}, {{0.4}, {v}}, {});
  CHECK(whole.end == DecayEnd::decayed);
  CHECK(whole.masses[0].drift == 0.0);
  CHECK_THAT(whole.masses[0].rest, WithinRel(0.4 + m * v / c, kExact));
}

TEST_CASE("A Maxwell element takes up momentum as its damper does") {
  const double m = 2.0, k = 5.0, c = 0.7, v = 1.5;
  const Network network{.masses = {"x"}, .elements = {on_the_mass("maxwell", ElementType::maxwell)}};
  const FreeDecay decay = free_decay(network, {.mass = {m}, .element = {k}, .second = {c}}, {{0.0}, {v}}, {});
  CHECK(decay.end == DecayEnd::decayed);
  CHECK_THAT(decay.masses[0].rest, WithinRel(m * v / c, 1e-12));
}

TEST_CASE("Two masses joined by a damper, or by a spring and a damper, drift on with their momentum") {
  for (const double k : {0.0, 4.0}) {
    for (const double light : {1.0, 1e-6, 1e-12}) {
      Network network = pair_with({{"spring", ElementType::spring, kFirst, kSecond},
                                   {"damper", ElementType::damper, kFirst, kSecond}});
      network.signals = {{"apart", mechanics::between(kFirst, kSecond)}};
      const NetworkValues values{.mass = {3.0, light}, .element = {k, 0.2 * std::sqrt(light)}};
      const double together = (3.0 * 0.5 + light * 2.0) / (3.0 + light);
      const FreeDecay decay = free_decay(network, values, {{0.1, 0.2}, {0.5, 2.0}}, {});
      INFO("k " << k << ", mass " << light << " " << decay.reason);
      CHECK(decay.end == DecayEnd::decayed);
      CHECK(std::isnan(decay.stop_time));
      for (std::size_t i = 0; i < 2; ++i) {
        CHECK_THAT(decay.masses[i].drift, WithinRel(together, 1e-12));
        CHECK(std::isnan(decay.masses[i].rest));
        CHECK(std::ranges::all_of(decay.masses[i].log_decrement, [](double d) { return std::isnan(d); }));
      }
      CHECK(decay.masses[2].drift == 0.0);
      // 0.1 apart at the start; without a spring (v_b - v_a) mu/c more
      const double mu = 3.0 * light / (3.0 + light);
      CHECK_THAT(decay.masses[2].rest, WithinAbs(k > 0.0 ? 0.0 : 0.1 + 1.5 * mu / (0.2 * std::sqrt(light)),
                                                 k > 0.0 ? 1e-12 : 1e-11));
      if (k == 0.0 || light < 1.0) continue;
      const double omega = std::sqrt(k / mu), zeta = 0.2 / (2.0 * mu * omega);
      CHECK_THAT(decay.masses[2].log_decrement[0],
                 WithinRel(kTurn * zeta / std::sqrt(1.0 - zeta * zeta), 1e-9));
    }
  }
}

TEST_CASE("A light mass goes on while a heavy one is stopped") {
  for (const double light : {1e-6, 1e-11, 1e-12}) {
    const Network network = pair_with(
        {on_the_mass("friction", ElementType::coulomb), {"damper", ElementType::damper, kGround, kSecond}});
    const NetworkValues values{.mass = {1.0, light}, .element = {1.0, 0.0}};
    const FreeDecay decay =
        free_decay(network, values, {{0.0, 0.0}, {1.0, 0.25}}, {.duration = 20.0, .samples = 21});
    INFO("mass " << light);
    CHECK_THAT(decay.history.displacement[0].back(), WithinRel(0.5, kExact));
    CHECK_THAT(decay.history.displacement[1].back(), WithinRel(5.0, kExact));
    CHECK_THAT(decay.masses[1].drift, WithinRel(0.25, kExact));
    CHECK_THAT(decay.masses[0].rest, WithinRel(0.5, kExact));
  }
}

TEST_CASE("A decay without an end of its own needs a duration, of any size") {
  const Network network = pair_with({{"inerter", ElementType::inerter, kFirst, kSecond}});
  const NetworkValues values{.mass = {1.0, 2.0}, .element = {0.5}};
  CHECK(has_no_end(network, values));
  CHECK_THROWS_WITH(free_decay(network, values, {{0.0, 0.0}, {1.0, 0.0}}, {}), Contains("needs a duration"));
  for (const double duration : {5e-9, 5.0, 5e9}) {
    const FreeDecay decay =
        free_decay(network, values, {{0.0, 0.0}, {1.0, 0.0}}, {.duration = duration, .samples = 3});
    CHECK_THAT(decay.history.displacement[0].back(), WithinRel(duration, kExact));
    CHECK(decay.history.displacement[1].back() == 0.0);
    CHECK_THAT(decay.masses[0].drift, WithinRel(1.0, kExact));
    CHECK(std::isnan(decay.masses[0].rest));
  }
  CHECK_FALSE(has_no_end(sliding_block(), {.mass = {1.0}, .element = {1.0}}));
  CHECK(has_no_end(sliding_block(), {.mass = {1.0}, .element = {0.0}}));
}

// m v^2 = k x^2: half a swing of sqrt(k/m) at the stop, and back with the same speed.
TEST_CASE("A mass bounces off a stop and is not at rest against it") {
  const Network network{.masses = {"x"}, .elements = {periodic::elastic_stops({1.0})}};
  const NetworkValues values{.mass = {4.0}, .element = {1.0}, .second = {0.0}, .bends = {{{1.0, 1.0, 0.0}}}};
  const double w = 0.5, hit = 1.0 / 0.3, leave = hit + std::numbers::pi / w;
  for (const double duration : {2.0, hit + 0.5 * std::numbers::pi / w, leave + 7.0}) {
    const FreeDecay decay = free_decay(network, values, {{0.0}, {0.3}}, {.duration = duration, .samples = 2});
    const double t = duration;
    const double x = t < hit     ? 0.3 * t
                     : t < leave ? 1.0 + 0.3 / w * std::sin(w * (t - hit))
                                 : 1.0 - 0.3 * (t - leave);
    INFO("duration " << duration);
    CHECK_THAT(decay.history.displacement[0].back(), WithinAbs(x, 1e-12));
    CHECK(decay.energy.balance < 1e-12);
  }
  // Let go from the stop, it flies off.
  const FreeDecay off = free_decay(network, values, {{1.5}, {0.0}}, {.duration = 20.0, .samples = 2});
  CHECK(off.end == DecayEnd::decayed);
  CHECK_THAT(off.masses[0].drift, WithinRel(-0.25, 1e-12));
  CHECK_THAT(off.history.displacement[0].back(), WithinRel(1.0 - 0.25 * (20.0 - std::numbers::pi), 1e-12));
}

TEST_CASE(
    "A force on a free mass: P t^2/(2 m), and -P cos(omega t)/(m omega^2) with the drift of its start") {
  Network network{.masses = {"x"}, .elements = {on_the_mass("damper", ElementType::damper)}};
  network.excitations = {{ExcitationKind::force, 0, 0}};
  NetworkValues values{.mass = {2.0}, .element = {0.0}, .excitation = {{3.0, 0.0}}};
  for (const double duration : {1e-6, 8.0, 5e9}) {
    const ForcedMotion motion =
        motion_of(network, values, {}, {.from = 1.0, .duration = duration, .samples = 3});
    REQUIRE(motion.failure.empty());
    CHECK_THAT(motion.history.displacement[0].back(), WithinRel(0.75 * duration * duration, kExact));
    CHECK(motion.energy.balance < 1e-12);
  }
  network.excitations = {{ExcitationKind::force, 0, 1}};
  values.excitation = {{3.0, 0.6}};
  const double w = 1.7;
  const ForcedMotion motion = motion_of(network, values, {}, {.from = w, .duration = 40.0, .samples = 41});
  REQUIRE(motion.failure.empty());
  for (std::size_t i = 0; i < motion.history.time.size(); ++i) {
    const double t = motion.history.time[i], a = 3.0 / (2.0 * w * w);
    const double x = -a * (std::cos(w * t + 0.6) - std::cos(0.6)) - a * w * std::sin(0.6) * t;
    CHECK_THAT(motion.history.displacement[0][i], WithinAbs(x, 1e-12));
  }
}

// A free shaft of two inertias under a torque on the first: the momentum is the torque's, and the twist
// swings as one mass on the spring does.
TEST_CASE("A free shaft turns and twists") {
  Network network = pair_with({{"shaft", ElementType::spring, kFirst, kSecond}});
  network.excitations = {{ExcitationKind::force, 0, 0}};
  const double J1 = 2.0, J2 = 0.5, k = 30.0, T = 4.0, t = 6.3;
  const ForcedMotion motion = motion_of(network, {.mass = {J1, J2}, .element = {k}, .excitation = {{T, 0.0}}},
                                        {}, {.from = 1.0, .duration = t, .samples = 2});
  REQUIRE(motion.failure.empty());
  const double w = std::sqrt(k * (1.0 / J1 + 1.0 / J2));
  const double twist = T / J1 / (w * w) * (1.0 - std::cos(w * t)), mean = 0.5 * T * t * t / (J1 + J2);
  CHECK_THAT(motion.history.displacement[0].back(), WithinRel(mean + J2 / (J1 + J2) * twist, 1e-12));
  CHECK_THAT(motion.history.displacement[1].back(), WithinRel(mean - J1 / (J1 + J2) * twist, 1e-12));
}

// Newmark's block: on a plane with the velocity a t until t0, then a t0. It slips V^2/(2 g mu) (1 - g mu/a).
TEST_CASE("Newmark's block slips as far as its formula says") {
  Network network{.masses = {"x"}, .prescribed = {"plane"}};
  network.elements = {{"friction", ElementType::coulomb, Node{NodeKind::prescribed, 0}, kFirst}};
  network.excitations = {{ExcitationKind::recorded_motion, 0, 0}};
  network.signals = {{"slip", mechanics::between(Node{NodeKind::prescribed, 0}, kFirst)}};
  const Record pulse{
      .name = "pulse", .of = RecordOf::velocity, .time = {0.0, 0.5, 4.0}, .values = {0.0, 1.5, 1.5}};
  const double m = 7.0, mu_g = 1.2, a = 3.0, V = 1.5;
  const NetworkValues values{.mass = {m}, .element = {m * mu_g}, .excitation = {{1.0, 0.0}}};
  const ForcedMotion motion =
      motion_of(network, values, {}, {.from = 1.0, .records = {{0, &pulse}}, .duration = 4.0, .samples = 3});
  REQUIRE(motion.failure.empty());
  const double slip = V * V / (2.0 * mu_g) * (1.0 - mu_g / a);
  CHECK(std::abs(motion.history.displacement[1].back() + slip) < 1e-13);
  CHECK(motion.energy.balance < kExact);
}

TEST_CASE("Free masses are refused where they are not allowed, and so is a stiffness that pushes") {
  const Network network = pair_with({{"spring", ElementType::spring, kFirst, kSecond}});
  mechanics::LinearSystem system;
  CHECK_THROWS_WITH(mechanics::Assembly(network).set_values({.mass = {1.0, 1.0}, .element = {4.0}}, system),
                    Contains("held by no spring"));
  CHECK_THROWS_WITH(mechanics::Assembly(network, FreeMasses::allowed)
                        .set_values({.mass = {1.0, 1.0}, .element = {-2.0}}, system),
                    Contains("a negative stiffness is too large"));
}

TEST_CASE("Modes of free masses: frequency 0 without a ratio, then those that oscillate") {
  Network network{.masses = {"a", "b", "c"}};
  network.elements = {{"spring", ElementType::spring, kFirst, kSecond},
                      {"brake", ElementType::coulomb, kGround, Node{NodeKind::mass, 2}}};
  network.damping = mechanics::DampingModel::modal;
  const NetworkValues values{.mass = {2.0, 2.0, 1.0}, .element = {9.0, 1.0}, .damping = {0.04}};
  const periodic::LinearModes modes = periodic::linear_modes(network, values, false, FreeMasses::allowed);
  REQUIRE(modes.frequency.size() == 3);
  for (const std::size_t free : {0U, 1U}) {
    CHECK(modes.frequency[free] == 0.0);
    CHECK(std::isnan(modes.damping[free]));
  }
  CHECK_THAT(modes.frequency[2], WithinRel(3.0, kExact));
  CHECK_THAT(modes.damping[2], WithinRel(0.04, 1e-12));  // the first ratio is of the first that oscillates
  CHECK_THAT(periodic::lowest_frequency(network, values, FreeMasses::allowed), WithinRel(3.0, kExact));
  const periodic::LinearModes stuck = periodic::linear_modes(network, values, true, FreeMasses::allowed);
  REQUIRE(stuck.frequency.size() == 2);
  CHECK(stuck.frequency[0] == 0.0);
  CHECK_THAT(stuck.frequency[1], WithinRel(3.0, kExact));
}

// The structure's damping has modes of its own, whose rounding must not hold what is free.
TEST_CASE("Damping of the structure leaves the momentum alone, or takes it as dampers to the ground do") {
  Network network = pair_with({{"spring", ElementType::spring, kFirst, kSecond}});
  network.signals = {{"apart", mechanics::between(kFirst, kSecond)}};
  NetworkValues values{.mass = {1.0, 2.0}, .element = {3.0}, .damping = {0.02}};
  network.damping = mechanics::DampingModel::modal;
  const FreeDecay modal = free_decay(network, values, {{0.0, 0.0}, {0.0, 1.0}}, {});
  CHECK(modal.end == DecayEnd::decayed);
  CHECK_THAT(modal.masses[0].drift, WithinRel(2.0 / 3.0, 1e-12));
  CHECK_THAT(modal.masses[1].drift, WithinRel(2.0 / 3.0, 1e-12));
  CHECK_THAT(modal.masses[2].log_decrement[0], WithinRel(kTurn * 0.02 / std::sqrt(1.0 - 4e-4), 1e-9));
  network.damping = mechanics::DampingModel::rayleigh;
  values.damping = {0.1, 0.001};
  const FreeDecay rayleigh = free_decay(network, values, {{0.0, 0.0}, {0.0, 1.0}}, {});
  CHECK(rayleigh.end == DecayEnd::decayed);
  CHECK_THAT(rayleigh.masses[0].rest, WithinRel(2.0 / (0.1 * 3.0), 1e-12));  // momentum over a M
  CHECK_THAT(rayleigh.masses[1].rest, WithinRel(2.0 / (0.1 * 3.0), 1e-12));
}

TEST_CASE("Free directions come from the springs, not from rounding") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> decades(-6.0, 6.0);
  for (int trial = 0; trial < 100; ++trial) {
    Network network;
    NetworkValues values;
    for (std::size_t i = 0; i < 6; ++i) {
      network.masses.push_back(std::string(1, static_cast<char>('a' + i)));
      values.mass.push_back(std::pow(10.0, decades(random)));
      if (i == 0 || i == 3) continue;  // two chains
      network.elements.push_back({"k" + std::to_string(i), ElementType::spring, Node{NodeKind::mass, i - 1},
                                  Node{NodeKind::mass, i}});
      values.element.push_back(std::pow(10.0, decades(random)));
    }
    mechanics::LinearSystem system;
    mechanics::Assembly(network, FreeMasses::allowed).set_values(values, system);
    CHECK(system.free_directions.cols() == 2);
    const Eigen::MatrixXd gram = system.free_directions.transpose() * system.M * system.free_directions;
    CHECK((gram - Eigen::Matrix2d::Identity()).norm() < 1e-12);
  }
}

TEST_CASE("Random networks with free masses move as the independent integration says", "[slow]") {
  constexpr double kIntegrated = 1e-10;  // relative to the largest displacement
  constexpr double kBalance = 1e-10;
  std::mt19937 random(20260901);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const int masses = 1 + trial % 4, free = masses > 1 && trial % 3 == 0 ? 2 : 1;
    const periodic::RandomNetwork drawn =
        periodic::without_some_springs({.masses = masses,
                                        .contacts = trial / 4 % 4,
                                        .maxwell_elements = trial % 5 == 3 ? 1 : 0,
                                        .stops = trial % 7 == 2 ? 1 : 0,
                                        .orders = {1},
                                        .shaken = false,
                                        .largest_friction = 0.5},
                                       free, trial % 2 == 0, random);
    InitialState initial;
    Eigen::VectorXd q(masses), v(masses);
    for (int i = 0; i < masses; ++i) {
      initial.displacement.push_back(q[i] = uniform(random));
      initial.velocity.push_back(v[i] = uniform(random));
    }
    mechanics::LinearSystem system;
    mechanics::Assembly(drawn.network, FreeMasses::allowed).set_values(drawn.values, system);
    constexpr int periods = 4;
    const double T = kTurn / drawn.values.omega;
    const ForcedMotion motion =
        motion_of(drawn.network, drawn.values, initial,
                  {.from = drawn.values.omega, .duration = periods * T, .samples = periods + 1});
    INFO("trial " << trial << " " << motion.failure);
    CHECK(system.free_directions.cols() >= free);
    REQUIRE(motion.failure.empty());
    CHECK(motion.energy.balance < kBalance);
    periodic::ExponentialIntegrator reference(drawn.network, drawn.values);
    reference.watches_extremes = false;
    reference.start(q, v);
    double error = 0.0, size = 1.0;
    for (std::size_t period = 1; period <= periods; ++period) {
      reference.pass_period();
      for (int i = 0; i < masses; ++i) {
        const double x = motion.history.displacement[static_cast<std::size_t>(i)][period];
        error = std::max(error, std::abs(x - reference.displacements()[i]));
        size = std::max(size, std::abs(x));
      }
    }
    CHECK(error < kIntegrated * size);
  }
}

TEST_CASE("Random networks with free masses let go come to rest, or drift on, where they are said to",
          "[slow]") {
  std::mt19937 random(20260902);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int at_rest = 0, drifting = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const int masses = 1 + trial % 4, free = masses > 1 && trial % 3 == 0 ? 2 : 1;
    periodic::RandomNetwork drawn =
        periodic::without_some_springs({.masses = masses,
                                        .contacts = trial / 4 % 3,
                                        .maxwell_elements = trial % 5 == 3 ? 1 : 0,
                                        .jenkins_elements = trial % 11 == 7 ? 1 : 0,
                                        .rising_dampers = trial % 13 == 5 ? 1 : 0,
                                        .stops = trial % 7 == 2 ? 1 : 0,
                                        .shaken = false,
                                        .largest_friction = 0.5},
                                       free, trial % 2 == 0, random);
    drawn.network.excitations.clear();
    drawn.values.excitation.clear();
    InitialState initial;
    Eigen::VectorXd q(masses), v(masses);
    for (int i = 0; i < masses; ++i) {
      initial.displacement.push_back(q[i] = uniform(random));
      initial.velocity.push_back(v[i] = uniform(random));
    }
    INFO("trial " << trial);
    if (has_no_end(drawn.network, drawn.values)) continue;
    const FreeDecay first = free_decay(drawn.network, drawn.values, initial, {});
    CHECK(first.end != DecayEnd::failed);
    if (first.end == DecayEnd::cut_off || first.end == DecayEnd::failed) continue;
    at_rest += first.end == DecayEnd::at_rest;
    const double duration = 3.0 * first.duration;
    const FreeDecay later =
        free_decay(drawn.network, drawn.values, initial, {.duration = duration, .samples = 4});
    CHECK(later.end != DecayEnd::failed);
    constexpr double kLater = 1e-8;  // the millionth that was left has decayed
    double size = 1.0;
    for (const auto& samples : later.history.displacement) size = std::max(size, std::abs(samples.back()));
    for (std::size_t i = 0; i < first.masses.size(); ++i) {
      INFO("mass " << i);
      const double drift = first.masses[i].drift;
      REQUIRE(std::isfinite(drift));
      if (drift == 0.0) {
        CHECK(std::abs(later.history.displacement[i].back() - first.masses[i].rest) < kLater * size);
      } else {
        ++drifting;
        CHECK(std::abs(later.history.velocity[i].back() - drift) < kLater);
        CHECK(std::isnan(first.masses[i].rest));
      }
    }
    // And there the independent integration is too.
    drawn.values.omega = kTurn / (duration / 3.0);
    periodic::ExponentialIntegrator reference(drawn.network, drawn.values);
    reference.watches_extremes = false;
    reference.start(q, v);
    reference.pass_period();
    for (std::size_t i = 0; i < first.masses.size(); ++i)
      CHECK(std::abs(later.history.displacement[i][1] -
                     reference.displacements()[static_cast<Eigen::Index>(i)]) < kLater * size);
  }
  CHECK(at_rest > 5);
  CHECK(drifting > 5);
}

}  // namespace
}  // namespace frahm::transient::free_masses_test
