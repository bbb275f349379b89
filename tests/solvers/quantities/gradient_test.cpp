#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "tests/known_answers/random_network.hpp"
#include "tests/known_answers/rig.hpp"
#include "tests/known_answers/single_mass.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Exact derivatives of periodic responses against differences of responses solved anew.
namespace frahm::periodic::gradient_test {
namespace {

using namespace mechanics;

// Of exact derivatives and differences, relative to the larger of the derivative and kSmallShare of quantity
// over parameter: what changes by less than a thousandth of the parameter's own change is judged by that.
constexpr double kDifference = 1e-6;
constexpr double kSmallShare = 1e-3;
// A difference that knows itself no better than this, relative to the same, decides nothing: an event is so
// near that only the smallest steps keep their events, or the quantity is small beside its noise (the phase
// of an absorber that hardly slips). Such differences are counted, and must still agree within their own
// uncertainty.
constexpr double kUndecided = 2e-7;
constexpr double kUncertainties = 10.0;
constexpr int kDecided = 50;  // differences that decide, for each that does not, at least
// A quantity below this [SI], where motions are of 1e-2 and more, is the rounding of zero.
constexpr double kRoundingOfZero = 1e-12;

struct Tally {
  int compared = 0, undecided = 0;
  bool has_gradient = false;
  std::string reason;
};

std::vector<double> quantities_of(const Network& network, const NetworkValues& values,
                                  const std::vector<Quantity>& quantities) {
  PeriodicResponse response(network, quantities);
  response.set_values(values);
  response.solve();
  std::vector<double> own(quantities.size());
  response.quantities(own);
  return own;
}

// Compares every derivative that there is, and fails the test where one is wrong.
Tally compare(const Network& network, const NetworkValues& values, const std::vector<NamedParameter>& named,
              const std::vector<Quantity>& quantities) {
  std::vector<CheckedParameter> parameters;
  for (const NamedParameter& parameter : named) parameters.push_back(parameter.parameter);
  const GradientCheck check = check_gradient(network, quantities, values, parameters);
  Tally tally{.has_gradient = check.reason.empty(), .reason = check.reason};
  if (!tally.has_gradient) return tally;
  const std::vector<double> own = quantities_of(network, values, quantities);
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (!(std::abs(own[i]) > kRoundingOfZero)) continue;
    for (std::size_t d = 0; d < named.size(); ++d) {
      const DerivativeCheck& by = check.columns[d][i];
      if (!by.why_none.empty()) continue;
      const double size =
          std::max(std::abs(by.exact), kSmallShare * std::abs(own[i] / named[d].parameter.value));
      const double apart = std::abs(by.exact - by.difference);
      const bool decides = by.uncertainty <= kUndecided * size;
      ++(decides ? tally.compared : tally.undecided);
      const double allowed = decides ? kDifference * size : kUncertainties * by.uncertainty;
      if (!(apart > allowed)) continue;
      INFO(describe(quantities[i], network, false).name << " = " << own[i] << " by " << named[d].name);
      INFO("exact " << by.exact << ", difference " << by.difference << " +- " << by.uncertainty);
      CHECK(apart <= allowed);
    }
  }
  return tally;
}

// The rig, and with `second` its exciter's second harmonic too, which breaks the symmetry of the forcing.
Network rig_with_harmonic(bool second) {
  Network network = rig();
  if (second) network.excitations.push_back({ExcitationKind::motion, 0, 2});
  return network;
}

int stops_of(const Network& network, const NetworkValues& values) {
  std::vector<Quantity> stops;
  for (const char* name : {"guide_stops", "tmd_friction_stops"})
    stops.push_back(*find_quantity(name, network));
  const std::vector<double> counts = quantities_of(network, values, stops);
  return static_cast<int>(counts[0] + counts[1]);
}

TEST_CASE("The rig's derivatives by k, c, I, D, d and omega are those of differences at 200 random points",
          "[slow]") {
  std::mt19937 random(20261121);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  std::set<int> stops_met;
  int points = 0, grazing = 0, compared = 0, undecided = 0;
  while (points < 200) {
    const bool second = points % 2 == 1;
    const Network network = rig_with_harmonic(second);
    NetworkValues values =
        rig_values(uniform(7.0, 36.0), uniform(4.7, 12.9), uniform(0.01, 0.7), uniform(1.0, 40.0));
    if (second) values.excitation.push_back({uniform(0.1, 0.6) * kRigCrank, uniform(0.0, 6.28)});
    const int stops = stops_of(network, values);
    if (stops > 4) continue;
    const std::vector<NamedParameter> parameters = {
        named_parameter("k", values, [](NetworkValues& v) -> double& { return v.element[0]; }),
        named_parameter("c", values, [](NetworkValues& v) -> double& { return v.element[5]; }),
        named_parameter("I", values, [](NetworkValues& v) -> double& { return v.element[6]; }),
        named_parameter("D", values, [](NetworkValues& v) -> double& { return v.element[3]; }),
        named_parameter("d", values, [](NetworkValues& v) -> double& { return v.element[7]; }),
        named_parameter("omega", values, [](NetworkValues& v) -> double& { return v.omega; })};
    INFO("point " << points << ", stops " << stops);
    const Tally tally = compare(network, values, parameters, all_quantities(network));
    ++points;
    if (!tally.has_gradient) {
      CHECK(tally.reason.rfind("grazing", 0) == 0);
      ++grazing;
      continue;
    }
    stops_met.insert(stops);
    compared += tally.compared;
    undecided += tally.undecided;
  }
  CHECK(stops_met == std::set<int>{0, 1, 2, 3, 4});
  CHECK(compared > 200 * 6 * 30);
  CHECK(undecided < compared / kDecided);
  CHECK(grazing < 5);
}

void compare_random_networks(unsigned first, unsigned trials) {
  const std::vector<std::vector<int>> orders = {{1}, {1, 3}, {1, 2}, {2}, {0, 1}};
  int with_gradient = 0, compared = 0, undecided = 0;
  for (unsigned trial = first; trial < first + trials; ++trial) {
    std::mt19937 random(1000U + trial);
    const RandomNetwork drawn = random_network({.masses = 1 + static_cast<int>(trial % 3),
                                                .contacts = static_cast<int>(trial % 4),
                                                .maxwell_elements = trial % 7 == 3 ? 2 : 0,
                                                .hysteretic = trial % 5 == 2,
                                                .orders = orders[trial % orders.size()],
                                                .shaken = trial % 2 == 0,
                                                .largest_friction = trial % 3 == 0 ? 2.0 : 0.5},
                                               random);
    INFO("trial " << trial);
    const Tally tally = compare(drawn.network, drawn.values, all_parameters(drawn.network, drawn.values),
                                all_quantities(drawn.network));
    with_gradient += tally.has_gradient ? 1 : 0;
    compared += tally.compared;
    undecided += tally.undecided;
  }
  CHECK(with_gradient >= 0.95 * trials);
  CHECK(undecided < compared / kDecided);
}

TEST_CASE("So are those of random networks by every number they have", "[slow]") {
  compare_random_networks(0, 20);
}

TEST_CASE("So are those of 40 more random networks by every number they have", "[long]") {
  compare_random_networks(20, 40);
}

TEST_CASE("So are those of random networks with damping of the structure, by its ratios too") {
  int with_gradient = 0, compared = 0, undecided = 0;
  for (unsigned trial = 0; trial < 12; ++trial) {
    std::mt19937 random(4000U + trial);
    RandomNetwork drawn = random_network({.masses = 2 + static_cast<int>(trial % 2),
                                          .contacts = static_cast<int>(trial % 3),
                                          .shaken = trial % 2 == 0,
                                          .largest_friction = 0.1},
                                         random);
    const bool is_modal = trial % 3 != 1;
    drawn.network.damping = is_modal ? mechanics::DampingModel::modal : mechanics::DampingModel::rayleigh;
    drawn.values.damping = {0.04, 0.07};
    INFO("trial " << trial);
    const std::vector<Quantity> quantities = all_quantities(drawn.network);
    const Tally tally =
        compare(drawn.network, drawn.values, all_parameters(drawn.network, drawn.values), quantities);
    with_gradient += tally.has_gradient ? 1 : 0;
    compared += tally.compared;
    undecided += tally.undecided;
  }
  CHECK(with_gradient >= 11);
  CHECK(undecided < compared / kDecided);
}

TEST_CASE("So are those of a mass shaken by a crank through a spring, by crank, rod and phase") {
  for (const int taylor_order : {0, 1, 2, 4}) {
    Network network = single_mass();
    network.prescribed = {"slider"};
    network.elements.push_back(
        {"drive", ElementType::spring, {mechanics::NodeKind::prescribed, 0}, {mechanics::NodeKind::mass, 0}});
    network.excitations = {{ExcitationKind::crank, 0, 1, 16, taylor_order}};
    const NetworkValues values{.omega = 1.1,
                               .mass = {1.0},
                               .element = {1.0, 0.1, 0.02, 0.5},
                               .excitation = {{.amplitude = 0.3, .phase = 0.4, .rod = 0.7}}};
    INFO("taylor_order " << taylor_order);
    const Tally tally = compare(network, values, all_parameters(network, values), all_quantities(network));
    CHECK(tally.has_gradient);
    CHECK(tally.compared > 100);
    CHECK(tally.undecided < tally.compared / kDecided);
  }
}

TEST_CASE(
    "A contact that sticks throughout to a moving support rests where the mean is least, and moves on") {
  // A mass bolted to a shaken base carries another, which slides; a constant load and a second harmonic leave
  // no symmetry.
  const mechanics::Node ground{}, base{mechanics::NodeKind::prescribed, 0},
      mass{mechanics::NodeKind::mass, 0}, rider{mechanics::NodeKind::mass, 1};
  Network network{.masses = {"mass", "rider"},
                  .prescribed = {"base"},
                  .elements = {{"spring", ElementType::spring, ground, mass},
                               {"damper", ElementType::damper, ground, mass},
                               {"bolt", ElementType::coulomb, base, mass},
                               {"link", ElementType::spring, mass, rider},
                               {"link_damper", ElementType::damper, mass, rider},
                               {"guide", ElementType::coulomb, ground, rider}}};
  network.excitations = {{ExcitationKind::motion, 0, 1},
                         {ExcitationKind::motion, 0, 2},
                         {ExcitationKind::force, 1, 1},
                         {ExcitationKind::force, 1, 0}};
  const NetworkValues values{.omega = 0.8,
                             .mass = {1.0, 0.7},
                             .element = {1.0, 0.1, 30.0, 0.8, 0.1, 0.15},
                             .excitation = {{0.6, 0.3}, {0.2, 1.0}, {0.5, 0.2}, {0.1, 0.0}}};
  const std::vector<double> stuck =
      quantities_of(network, values, {*find_quantity("bolt_stuck_fraction", network)});
  CHECK(stuck[0] == 1.0);
  const Tally tally = compare(network, values, all_parameters(network, values), all_quantities(network));
  CHECK(tally.has_gradient);
  CHECK(tally.compared > 300);
  CHECK(tally.undecided < tally.compared / kDecided);
}

TEST_CASE(
    "One-sided peaks are the largest value and the least with its sign turned, with their derivatives") {
  const Network network = rig_with_harmonic(true);
  NetworkValues values = rig_values(22.0, 6.36, 0.05);
  values.excitation.push_back({0.4 * kRigCrank, 1.0});
  std::vector<Quantity> quantities;
  for (const Measure measure : {Measure::peak, Measure::velocity_peak, Measure::acceleration_peak,
                                Measure::stroke, Measure::force_peak, Measure::transmitted_force}) {
    for (const Side side : {Side::either, Side::most, Side::least}) quantities.push_back({measure, 0, side});
  }
  const std::vector<double> own = quantities_of(network, values, quantities);
  for (std::size_t i = 0; i < own.size(); i += 3) CHECK(own[i] == std::max(own[i + 1], own[i + 2]));
  const Tally tally = compare(network, values, all_parameters(network, values), quantities);
  CHECK(tally.has_gradient);
  CHECK(tally.compared > 150);
  CHECK(tally.undecided < tally.compared / kDecided);
  for (const Quantity& quantity : all_quantities(network)) CHECK(quantity.side == Side::either);
}

}  // namespace
}  // namespace frahm::periodic::gradient_test
