#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"

// Signals of a motion from initial values, against the masses they are made of and closed forms.
namespace frahm::transient::signal_motion_test {
namespace {

using mechanics::ElementType, mechanics::ExcitationKind, mechanics::Network, mechanics::NetworkValues;
using mechanics::Node, mechanics::NodeKind;

constexpr double kSame = 1e-12;
const Node base{NodeKind::prescribed, 0}, ground{}, lower{NodeKind::mass, 0}, roof{NodeKind::mass, 1};

// Two storeys with a friction brace in the upper one.
Network storeys(const Node& foot) {
  Network network;
  network.masses = {"lower", "roof"};
  network.elements = {{"columns", ElementType::spring, foot, lower},
                      {"upper_columns", ElementType::spring, lower, roof},
                      {"damper", ElementType::damper, foot, lower},
                      {"brace", ElementType::coulomb, lower, roof}};
  return network;
}

NetworkValues values_of_storeys(double friction) {
  return {.omega = 1.0, .mass = {1.0, 0.7}, .element = {1.0, 0.8, 0.1, friction}};
}

TEST_CASE("a decay tells of a signal of one mass what it tells of the mass") {
  Network network = storeys(ground);
  network.signals = {{"again", {{roof, 1.0}}}, {"drift", {{roof, 1.0}, {lower, -1.0}}}};
  for (const double friction : {0.0, 0.02, 0.2}) {
    INFO("friction " << friction);
    const FreeDecay decay =
        free_decay(network, values_of_storeys(friction), {{0.5, 1.0}, {0.0, 0.1}}, {.samples = 101});
    REQUIRE(decay.masses.size() == 4);
    const DecayOfMass &own = decay.masses[1], &again = decay.masses[2], &drift = decay.masses[3];
    REQUIRE(own.extrema.size() == again.extrema.size());
    CHECK(own.extrema.size() > 4);
    for (std::size_t i = 0; i < own.extrema.size(); ++i) {
      CHECK(std::abs(own.extrema[i].time - again.extrema[i].time) <= kSame * own.extrema[i].time);
      CHECK(std::abs(own.extrema[i].displacement - again.extrema[i].displacement) <= kSame);
    }
    CHECK(own.rest == again.rest);
    CHECK(std::abs(drift.rest - (own.rest - decay.masses[0].rest)) <= kSame);
    CHECK(decay.history.displacement[2] == decay.history.displacement[1]);
    CHECK(decay.history.velocity[2] == decay.history.velocity[1]);
    CHECK(decay.history.acceleration[2] == decay.history.acceleration[1]);
    for (std::size_t i = 0; i < decay.history.time.size(); ++i) {
      const double parts = decay.history.displacement[1][i] - decay.history.displacement[0][i];
      CHECK(std::abs(decay.history.displacement[3][i] - parts) <= kSame);
    }
  }
}

TEST_CASE("the drift of a storey turns where its brace stops") {
  Network network = storeys(ground);
  network.signals = {{"drift", {{roof, 1.0}, {lower, -1.0}}}};
  const NetworkValues values = values_of_storeys(0.1);
  const ForcedMotion motion = forced_motion(network, [&](double) { return values; }, {{0.0, 1.0}, {}},
                                            {.from = 1.0, .duration = 20.0});
  REQUIRE(motion.failure.empty());
  REQUIRE(!motion.stops[0].empty());
  // The first and largest drift is the initial one.
  CHECK(motion.peaks[2].displacement == 1.0);
  const FreeDecay decay = free_decay(network, values, {{0.0, 1.0}, {}}, {.duration = 20.0});
  const auto& turns = decay.masses[2].extrema;
  for (const Stop& stop : motion.stops[0]) {
    INFO("stop at " << stop.onset);
    CHECK(std::ranges::any_of(turns,
                              [&](const Extremum& turn) { return std::abs(turn.time - stop.onset) < 1e-9; }));
  }
}

// One mass on a moving base, from rest: relative to it z'' + 2 zeta z' + z = -y''.
Network on_base() {
  Network network;
  network.masses = {"lower"};
  network.prescribed = {"base"};
  network.elements = {{"spring", ElementType::spring, base, lower},
                      {"damper", ElementType::damper, base, lower}};
  network.excitations = {{ExcitationKind::motion, 0, 1}};
  network.signals = {{"relative", {{lower, 1.0}, {base, -1.0}}}};
  return network;
}

TEST_CASE("the motion relative to a base in steady state has the amplitude r^2/|1 - r^2 + 2 i zeta r|") {
  constexpr double zeta = 0.4, r = 1.5;
  const NetworkValues values{.omega = r, .mass = {1.0}, .element = {1.0, 2.0 * zeta}, .excitation = {{1.0}}};
  const ForcedMotion motion = forced_motion(on_base(), [&](double) { return values; }, {},
                                            {.from = r, .duration = 200.0, .samples = 8001});
  REQUIRE(motion.failure.empty());
  const double amplitude = r * r / std::hypot(1.0 - r * r, 2.0 * zeta * r);
  const auto largest_late = [&](const std::vector<double>& samples) {
    double largest = 0.0;
    for (std::size_t i = samples.size() / 2; i < samples.size(); ++i)
      largest = std::max(largest, std::abs(samples[i]));
    return largest;
  };
  constexpr double kSampled = 1e-5;  // of the largest of samples, 170 a period, over 24 of them
  CHECK(std::abs(largest_late(motion.history.displacement[1]) / amplitude - 1.0) < kSampled);
  CHECK(std::abs(largest_late(motion.history.velocity[1]) / (r * amplitude) - 1.0) < kSampled);
  CHECK(std::abs(largest_late(motion.history.acceleration[1]) / (r * r * amplitude) - 1.0) < kSampled);
  // From rest at y = 1: the signal begins at -1.
  CHECK(motion.history.displacement[1].front() == -1.0);
  CHECK(std::abs(motion.peaks[1].displacement) >= largest_late(motion.history.displacement[1]));
}

// z'' + 2 zeta z' + z = -y'' with y = cos phi, phi = omega_0 t + alpha t^2/2, so that
// y'' = -omega^2 cos phi - alpha sin phi.
TEST_CASE("in a run-up the motion relative to the base obeys its equation, the frequency's rise included") {
  constexpr double zeta = 0.1, from = 0.1, alpha = 0.2, end = 1.1;
  const auto values_at = [](double omega) {
    return NetworkValues{.omega = omega, .mass = {1.0}, .element = {1.0, 2.0 * zeta}, .excitation = {{1.0}}};
  };
  const ForcedMotion motion = forced_motion(
      on_base(), values_at, {},
      {.from = from, .run_up = {.to = end, .rate = alpha}, .duration = (end - from) / alpha, .samples = 501});
  REQUIRE(motion.failure.empty());
  constexpr double kStairs = 2e-3;  // of the base's acceleration on stairs, of which alpha sin phi is 0.2
  for (std::size_t i = 0; i < 500; ++i) {
    const double t = motion.history.time[i], omega = from + alpha * t, phi = (from + 0.5 * alpha * t) * t;
    const double shaken = -omega * omega * std::cos(phi) - alpha * std::sin(phi);
    const double left = motion.history.acceleration[1][i] + 2.0 * zeta * motion.history.velocity[1][i] +
                        motion.history.displacement[1][i] + shaken;
    INFO("t = " << t);
    CHECK(std::abs(left) < kStairs);
  }
}

}  // namespace
}  // namespace frahm::transient::signal_motion_test
