#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "tests/known_answers/event_integrator.hpp"
#include "tests/known_answers/random_network.hpp"

// Networks drawn at random, from initial values drawn at random, against the independent integration.
namespace frahm::transient::random_motions_test {
namespace {

using periodic::random_network, periodic::RandomNetwork;
constexpr double kIntegrated = 1e-8;  // relative; the reference's own error over dozens of events
constexpr double kBalance = 1e-11;    // of the energies, with impulses of up to six contacts at once

struct Start {
  InitialState state;
  Eigen::VectorXd q, v;
};
Start random_start(std::size_t masses, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Start start;
  start.q.resize(static_cast<Eigen::Index>(masses));
  start.v.resizeLike(start.q);
  for (std::size_t i = 0; i < masses; ++i) {
    start.state.displacement.push_back(uniform(random));
    start.state.velocity.push_back(uniform(random));
    start.q[static_cast<Eigen::Index>(i)] = start.state.displacement[i];
    start.v[static_cast<Eigen::Index>(i)] = start.state.velocity[i];
  }
  return start;
}

mechanics::LinearSystem system_of(const RandomNetwork& drawn) {
  const mechanics::Assembly assembly(drawn.network);
  mechanics::LinearSystem system;
  assembly.set_values(drawn.values, system);
  assembly.set_forcing(drawn.values, system);
  return system;
}

// The largest difference to the reference at the history's times.
double largest_error(const Samples& history, periodic::EventIntegrator& reference) {
  double error = 0.0;
  for (std::size_t i = 1; i < history.time.size(); ++i) {
    reference.advance_to(history.time[i]);
    const Eigen::VectorXd q = reference.displacements();
    for (std::size_t mass = 0; mass < history.displacement.size(); ++mass) {
      error = std::max(error, std::abs(history.displacement[mass][i] - q[static_cast<Eigen::Index>(mass)]));
    }
  }
  return error;
}

TEST_CASE("Random networks let go decay as the independent integration says", "[slow]") {
  std::mt19937 random(20240611);
  int at_rest = 0;
  for (int trial = 0; trial < 60; ++trial) {
    RandomNetwork drawn = random_network({.masses = 1 + trial % 4,
                                          .contacts = trial / 4 % 6,
                                          .maxwell_elements = trial % 3 == 2 ? 1 + trial % 2 : 0,
                                          .orders = {1},
                                          .shaken = false,
                                          .largest_friction = 0.4},
                                         random);
    drawn.network.excitations.clear();
    drawn.values.excitation.clear();
    const Start start = random_start(drawn.network.masses.size(), random);
    const FreeDecay decay =
        free_decay(drawn.network, drawn.values, start.state, {.duration = 15.0, .samples = 31});
    INFO("trial " << trial << " " << decay.reason);
    REQUIRE(decay.end != DecayEnd::failed);
    CHECK(decay.end != DecayEnd::cut_off);  // every mass is damped
    CHECK(decay.energy.balance < kBalance);
    CHECK(decay.energy.input == 0.0);
    at_rest += decay.end == DecayEnd::at_rest;
    const mechanics::LinearSystem system = system_of(drawn);
    periodic::EventIntegrator reference(system);
    reference.start(0.0, start.q, start.v);
    CHECK(largest_error(decay.history, reference) < kIntegrated);
    if (decay.stop_time > 15.0 || std::isnan(decay.stop_time)) continue;
    for (std::size_t i = 0; i < decay.masses.size(); ++i)
      CHECK(std::abs(decay.masses[i].rest - reference.displacements()[static_cast<Eigen::Index>(i)]) <
            kIntegrated);
  }
  CHECK(at_rest > 5);
}

TEST_CASE("Random networks shaken from random initial values move as the independent integration says",
          "[slow]") {
  std::mt19937 random(20240612);
  for (int trial = 0; trial < 40; ++trial) {
    const RandomNetwork drawn =
        random_network({.masses = 1 + trial % 3,
                        .contacts = trial % 4,
                        .maxwell_elements = trial / 4 % 2,
                        .hysteretic = trial % 8 == 5,
                        .orders = trial % 5 == 0 ? std::vector{1, 2} : std::vector{1}},
                       random);
    const Start start = random_start(drawn.network.masses.size(), random);
    const double duration = 3.3 * 2.0 * std::numbers::pi / drawn.values.omega;
    const ForcedMotion motion =
        forced_motion(drawn.network, [&](double) { return drawn.values; }, start.state,
                      {.from = drawn.values.omega, .duration = duration, .samples = 21});
    INFO("trial " << trial);
    REQUIRE(motion.failure.empty());
    CHECK(motion.energy.balance < kBalance);
    const mechanics::LinearSystem system = system_of(drawn);
    periodic::EventIntegrator reference(system);
    reference.start(0.0, start.q, start.v);
    CHECK(largest_error(motion.history, reference) <
          kIntegrated * std::max(1.0, std::abs(motion.peaks[0].displacement)));
  }
}

TEST_CASE("Random networks in a run-up lose what they are given", "[long]") {
  std::mt19937 random(20240613);
  for (int trial = 0; trial < 16; ++trial) {
    const RandomNetwork drawn = random_network({.masses = 1 + trial % 3,
                                                .contacts = trial % 4,
                                                .maxwell_elements = trial / 4 % 2,
                                                .hysteretic = trial % 8 == 5,
                                                .orders = {1}},
                                               random);
    const Start start = random_start(drawn.network.masses.size(), random);
    const ValuesAt values_at = [&](double omega) {
      mechanics::NetworkValues values = drawn.values;
      values.omega = omega;
      return values;
    };
    const ForcedMotion motion =
        forced_motion(drawn.network, values_at, start.state,
                      {.from = 0.5, .run_up = {1.5, 0.1}, .duration = 12.0, .samples = 21});
    INFO("trial " << trial);
    REQUIRE(motion.failure.empty());
    CHECK(motion.energy.balance < kBalance);
  }
}

}  // namespace
}  // namespace frahm::transient::random_motions_test
