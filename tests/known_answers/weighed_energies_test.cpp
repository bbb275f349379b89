// What decides whether a motion or an orbit is right, whatever is asked of it: the totals of its energies,
// against the account of each element, and against motions that are wrong.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "solvers/orbits/continuation.hpp"
#include "solvers/quantities/observables.hpp"
#include "solvers/transient/energy_account.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "tests/known_answers/random_network.hpp"
#include "tests/known_answers/single_mass.hpp"

namespace frahm::transient::weighed_energies_test {
namespace {

using Catch::Matchers::WithinAbs;
using mechanics::ElementType, mechanics::ExcitationKind, mechanics::Network, mechanics::NetworkValues;
using mechanics::Node, mechanics::NodeKind;

constexpr double kTotals = 1e-12;  // of all that was put in, stored or lost: roundings of thousands of steps

// The motion with its totals alone, and with the account of each element. Whether the totals sufficed.
bool compare(const Network& network, const NetworkValues& values, ForcedOptions options) {
  const MotionQuantity peak{MotionMeasure::peak, 0};
  options.quantities = {};
  const auto values_at = [&](double) { return values; };
  const ForcedMotion plain = forced_motion(network, values_at, {}, options);
  options.quantities = std::span(&peak, 1);
  const ForcedMotion weighed = forced_motion(network, values_at, {}, options);
  REQUIRE(plain.failure == weighed.failure);
  if (!plain.failure.empty() || weighed.energy.dissipated.size() != 1) return false;
  const EnergyBudget &a = plain.energy, &b = weighed.energy;
  const double lost = std::accumulate(a.dissipated.begin(), a.dissipated.end(), 0.0);
  const double size = std::max({a.initial, a.final, lost, std::abs(a.input)});
  CHECK_THAT(b.input, WithinAbs(a.input, kTotals * size));
  CHECK_THAT(b.dissipated[0], WithinAbs(lost, kTotals * size));
  CHECK_THAT(b.final, WithinAbs(a.final, kTotals * size));
  CHECK(b.balance <= 1e-7);
  return true;
}

// Thousands of steps, most of them whole ones of modes that come again.
TEST_CASE("The totals of a motion's energies are those of its elements together") {
  std::mt19937 random(53);
  int sufficed = 0, drawn = 0;
  for (int i = 0; i < 60; ++i, ++drawn) {
    periodic::RandomNetworkOptions options{.masses = 1 + i % 4, .contacts = i % 3};
    options.maxwell_elements = i % 2;
    options.hysteretic = i % 5 == 0;
    options.jenkins_elements = i % 4 == 1 ? 1 : 0;
    options.rising_dampers = i % 6 == 2 ? 1 : 0;
    options.falling_dampers = i % 12 == 3 ? 1 : 0;
    options.stops = i % 6 == 4 ? 1 : 0;
    options.two_sided_stops = i % 10 == 7 ? 1 : 0;
    options.spring_tables = i % 10 == 8 ? 1 : 0;
    options.static_friction = i % 7 == 6;
    options.orders = i % 3 == 0 ? std::vector{1} : std::vector{1, 2};
    options.largest_friction = 0.3;
    auto [network, values] = random_network(options, random);
    if (i % 4 == 3) {
      network.damping = mechanics::DampingModel::rayleigh;
      values.damping = {0.03, 0.02};
    }
    INFO("network " << i);
    const double period = 2.0 * std::numbers::pi / values.omega;
    sufficed += compare(network, values, {.from = values.omega, .duration = 60.0 * period});
  }
  INFO(sufficed << " of " << drawn);
  CHECK(sufficed >= drawn - 3);
}

TEST_CASE("So are those of motions under records, and of a block on a belt") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Record record;
  record.name = "noise";
  record.of = RecordOf::acceleration;
  for (int i = 0; i < 400; ++i) {
    record.time.push_back(0.1 * i);
    record.values.push_back(uniform(random));
  }
  for (int i = 0; i < 8; ++i) {
    periodic::RandomNetworkOptions drawn{.masses = 1 + i % 3, .contacts = 1};
    drawn.maxwell_elements = i % 2;
    auto [network, values] = periodic::random_network(drawn, random);
    network.excitations = {{ExcitationKind::recorded_motion, 0, 0}};
    values.excitation = {{1.0}};
    INFO("network " << i);
    CHECK(compare(network, values,
                  {.from = values.omega, .records = {{0, &record}}, .duration = record.time.back()}));
  }

  Network block;
  block.masses = {"block"};
  block.prescribed = {"belt"};
  const Node mass{NodeKind::mass, 0}, belt{NodeKind::prescribed, 0};
  block.elements = {{"spring", ElementType::spring, Node{}, mass},
                    {"friction", ElementType::coulomb, belt, mass}};
  block.elements[1].has_static_force = true;
  block.excitations = {{ExcitationKind::belt, 0, 0}, {ExcitationKind::force, 0, 1}};
  CHECK(compare(block,
                {.omega = 0.7,
                 .mass = {1.0},
                 .element = {1.0, 0.5},
                 .excitation = {{0.3}, {0.2}},
                 .second = {0.0, 0.8}},
                {.from = 0.7, .duration = 300.0}));
}

// A mass thrown against friction of the right or the wrong direction, which drives it.
std::string verdict_on_throw(EnergyDetail detail, bool right) {
  const mechanics::Assembly assembly(periodic::single_mass());
  mechanics::LinearSystem system;
  const NetworkValues values = periodic::single_mass_values(0.05, 0.02, 0.4);
  assembly.set_values(values, system);
  assembly.set_forcing(values, system);
  EnergyAccount::Flow flow;
  flow.set_system(system);
  flow.set_forcing(system);
  EnergyAccount account(assembly, flow, detail);
  account.set_system(system);
  EnergyAccount::State z(2);
  z << -40.0, 30.0 * flow.equations().step;
  account.open(account.energy_of(z, 0.0));
  const auto& mode = flow.mode(flow.mode_index(0, right ? 1 : 0, 0));
  EnergyAccount::Instant at, next;
  EnergyAccount::Expansion x;
  flow.instant_at(z, 0.0, mode, at);
  // To the position of rest: not far enough to turn.
  int steps = 0;
  for (; at.z[0] < 0.0; ++steps) {
    flow.step(at, mode, next, x);
    if (!account.follow_whole(mode, at, next)) {
      flow.expand(at, mode, x);
      account.follow(mode, x, 1.0);
    }
    at = next;
  }
  return why_unbalanced(account.budget(account.energy_of(at.z, steps * flow.fundamental_rate())));
}

TEST_CASE("A motion whose friction drives it is called unbalanced, by its totals too") {
  for (const EnergyDetail detail : {EnergyDetail::total, EnergyDetail::each}) {
    CHECK(verdict_on_throw(detail, true).empty());
    CHECK_FALSE(verdict_on_throw(detail, false).empty());
  }
}

TEST_CASE("An orbit whose friction drives it is called unbalanced though only a displacement is asked for") {
  using namespace periodic;
  const mechanics::Assembly assembly(single_mass());
  for (const double r : {0.3, 0.7, 1.3}) {
    mechanics::LinearSystem system;
    const NetworkValues values = single_mass_values(r, 0.05, 0.3);
    assembly.set_values(values, system);
    assembly.set_forcing(values, system);
    Flow<1, 1> flow;
    flow.set_system(system);
    flow.set_forcing(system);
    Continuation<1, 1> continuation(flow);
    Orbit<1, 1> orbit;
    continuation.find(system, orbit);
    REQUIRE(orbit.is_found());
    for (const Measure asked : {Measure::peak, Measure::energy_balance}) {
      Observables<1, 1> observables(assembly, flow, {{asked, 0}});
      observables.set_system(system);
      INFO("r " << r);
      CHECK(observables.is_balanced(orbit, system));
      Orbit<1, 1> wrong = orbit;
      for (auto& segment : wrong.passage.segments) {
        const auto mode = flow.mode(segment.mode);
        segment.mode = flow.mode_index(mode.stuck, ~mode.positive & 1, mode.beyond);
      }
      CHECK_FALSE(observables.is_balanced(wrong, system));
      // A contact that is said to stick and slides.
      wrong = orbit;
      wrong.passage.segments.front().z[1] += 0.1 * flow.equations().step;
      CHECK_FALSE(observables.is_balanced(wrong, system));
    }
  }
}

}  // namespace
}  // namespace frahm::transient::weighed_energies_test
