#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/laws/damper_bend.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "solvers/laws/spring_bend.hpp"
#include "solvers/orbits/orbit.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Exact derivatives of responses whose elements bend, or stick harder than they slide, against differences of
// responses solved anew.
namespace frahm::periodic::bend_gradient_test {
namespace {

using laws::damper_bend, laws::elastic_stop, laws::spring_bend;
using namespace mechanics;

// Of exact derivatives and differences, relative to the larger of the derivative and kSmallShare of quantity
// over parameter.
constexpr double kDifference = 1e-6;
constexpr double kSmallShare = 1e-3;
// A difference that knows itself no better than this, relative to the same, decides nothing.
constexpr double kUndecided = 2e-7;
constexpr double kUncertainties = 10.0;
constexpr double kRoundingOfZero = 1e-11;

const Node ground{}, first{NodeKind::mass, 0}, second{NodeKind::mass, 1}, base{NodeKind::prescribed, 0};

struct Tally {
  int decided = 0, undecided = 0;
};

// Compares every derivative that there is, by every number that is not zero.
Tally compare(const Network& network, const NetworkValues& values) {
  const std::vector<Quantity> quantities = all_quantities(network);
  PeriodicResponse response(network, quantities);
  response.set_values(values);
  const Status status = response.solve().status;
  REQUIRE((status == Status::ok || status == Status::several));
  std::vector<double> own(quantities.size());
  response.quantities(own);

  const std::vector<NamedParameter> named = all_parameters(network, values);
  std::vector<CheckedParameter> parameters;
  for (const NamedParameter& parameter : named) parameters.push_back(parameter.parameter);
  const GradientCheck check = check_gradient(network, quantities, values, parameters);
  REQUIRE(check.reason.empty());
  Tally tally;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (!(std::abs(own[i]) > kRoundingOfZero)) continue;
    for (std::size_t d = 0; d < named.size(); ++d) {
      const DerivativeCheck& by = check.columns[d][i];
      if (!by.why_none.empty()) continue;
      const double size =
          std::max(std::abs(by.exact), kSmallShare * std::abs(own[i] / named[d].parameter.value));
      const double apart = std::abs(by.exact - by.difference);
      const bool decides = by.uncertainty <= kUndecided * size;
      ++(decides ? tally.decided : tally.undecided);
      const double allowed = decides ? kDifference * size : kUncertainties * by.uncertainty;
      if (apart <= allowed) continue;
      INFO(describe(quantities[i], network, false).name << " = " << own[i] << " by " << named[d].name);
      INFO("exact " << by.exact << ", difference " << by.difference << " +- " << by.uncertainty);
      CHECK(apart <= allowed);
    }
  }
  return tally;
}

void check_all(const Network& network, const NetworkValues& values, int at_least) {
  const Tally tally = compare(network, values);
  INFO(tally.decided << " decided, " << tally.undecided << " not");
  CHECK(tally.decided >= at_least);
  CHECK(tally.undecided * 20 <= tally.decided);
}

// A mass on a spring and a damper, driven by a force, and a third element.
Network one_mass(const mechanics::Element& third) {
  Network network;
  network.masses = {"mass"};
  network.elements = {
      {"spring", ElementType::spring, ground, first}, {"damper", ElementType::damper, ground, first}, third};
  network.excitations = {{ExcitationKind::force, 0, 1}};
  return network;
}

mechanics::Element stops(Node a, Node b, bool both) {
  mechanics::Element gap{"stops", ElementType::gap, a, b};
  gap.bends = {{+1.0, &elastic_stop}};
  if (both) gap.bends.push_back({-1.0, &elastic_stop});
  return gap;
}

// Three masses, the last one before a stop, driven at a resonance by a force with a mean: where the parameter
// changes by more than 1e-4, the differences have passed the kink of the touch, though they settle.
TEST_CASE("A difference beside a derivative is of steps that agree with the shortest ones") {
  const Node third{NodeKind::mass, 2};
  Network network;
  network.masses = {"first", "second", "third"};
  network.elements = {{"a", ElementType::spring, ground, first},
                      {"b", ElementType::damper, ground, first},
                      {"c", ElementType::spring, first, second},
                      {"d", ElementType::damper, first, second},
                      {"e", ElementType::spring, second, third},
                      {"f", ElementType::damper, second, third},
                      stops(ground, third, true)};
  network.excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::force, 0, 0}};
  constexpr double kStiffness = 0.159, kDamping = 0.0159, kClearance = 1.242;
  const NetworkValues values{
      .omega = 1.7806,
      .mass = {1.0, 1.0, 1.0},
      .element = {1.0, 0.02, 1.0, 0.02, 1.0, 0.02, kStiffness},
      .excitation = {{1.0, 0.0}, {0.3, 0.0}},
      .second = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, kDamping},
      .bends = {
          {}, {}, {}, {}, {}, {}, {{kClearance, kStiffness, kDamping}, {kClearance, kStiffness, kDamping}}}};
  CHECK(compare(network, values).decided > 500);
}

TEST_CASE(
    "The derivatives of a mass between stops are those of differences, on the larger of two orbits too") {
  for (const double omega : {1.3, 1.5}) {
    const NetworkValues values{.omega = omega,
                               .mass = {1.0},
                               .element = {1.0, 0.1, 4.0},
                               .excitation = {{1.0, 0.0}},
                               .second = {0.0, 0.0, 0.0},
                               .bends = {{}, {}, {{1.0, 4.0, 0.0}, {0.9, 3.0, 0.0}}}};
    check_all(one_mass(stops(ground, first, true)), values, 100);
  }
}

TEST_CASE("So are those with damping in the stops, whose forces jump") {
  for (const double omega : {0.7, 1.2}) {
    const NetworkValues values{.omega = omega,
                               .mass = {1.0},
                               .element = {1.0, 0.1, 4.0},
                               .excitation = {{1.0, 0.3}},
                               .second = {0.0, 0.0, 0.2},
                               .bends = {{}, {}, {{1.0, 4.0, 0.2}, {0.9, 3.0, 0.5}}}};
    check_all(one_mass(stops(ground, first, true)), values, 100);
  }
}

TEST_CASE("So are those of responses that take two periods of the excitation") {
  Network network = one_mass(stops(base, first, false));
  network.prescribed = {"base"};
  network.excitations.push_back({ExcitationKind::force, 0, 0});
  network.excitations.push_back({ExcitationKind::motion, 0, 1});
  for (const double omega : {2.4, 3.1}) {
    const NetworkValues values{.omega = omega,
                               .mass = {1.0},
                               .element = {1.0, 0.06, 3.0},
                               .excitation = {{1.0, 0.0}, {0.3, 0.0}, {0.01, 0.3}},
                               .second = {0.0, 0.0, 0.1},
                               .bends = {{}, {}, {{0.2, 3.0, 0.1}}}};
    PeriodicResponse response(network, {});
    response.set_values(values);
    CHECK(response.solve().multiple == 2);
    check_all(network, values, 100);
  }
}

TEST_CASE("So are those of a spring with a table and of a damper with one") {
  Network network = one_mass({"friction", ElementType::coulomb, ground, first});
  network.elements[0].bends = {{+1.0, &spring_bend}, {-1.0, &spring_bend}};
  network.elements[1].bends = {{+1.0, &damper_bend}, {-1.0, &damper_bend}};
  network.excitations.push_back({ExcitationKind::force, 0, 0});
  const NetworkValues values{
      .omega = 0.8,
      .mass = {1.3},
      .element = {1.0, 0.2, 0.1},
      .excitation = {{1.0, 0.3}, {0.2, 0.0}},
      .second = {0.0, 0.0, 0.0},
      .bends = {{{0.5, -0.4, 0.0}, {0.7, 0.8, 0.0}}, {{0.2, 0.0, -0.1}, {0.1, 0.0, 0.3}}, {}}};
  check_all(network, values, 100);
}

TEST_CASE("So are those of friction that sticks harder than it slides, with two stops a period") {
  Network network = one_mass({"friction", ElementType::coulomb, ground, first});
  network.elements[2].has_static_force = true;
  const NetworkValues values{.omega = 0.5,
                             .mass = {1.0},
                             .element = {1.0, 0.1, 0.3},
                             .excitation = {{1.0, 0.0}},
                             .second = {0.0, 0.0, 0.6}};
  check_all(network, values, 50);
}

TEST_CASE("So are those of two guides side by side, one of which sticks harder than it slides") {
  Network network = one_mass({"friction", ElementType::coulomb, ground, first});
  network.elements[2].has_static_force = true;
  network.elements.push_back({"plain", ElementType::coulomb, ground, first});
  const NetworkValues values{.omega = 0.3,
                             .mass = {1.0},
                             .element = {1.0, 0.1, 0.3, 0.25},
                             .excitation = {{1.0, 0.0}},
                             .second = {0.0, 0.0, 0.6, 0.0}};
  check_all(network, values, 50);
}

// Both the table's point and the friction are at zero velocity.
TEST_CASE("So are those of a damper that is stiffer one way, beside friction with a static limit") {
  Network network = one_mass({"friction", ElementType::coulomb, ground, first});
  network.elements[1].bends = {{+1.0, &damper_bend}};
  network.elements[2].has_static_force = true;
  const NetworkValues values{.omega = 0.5,
                             .mass = {1.0},
                             .element = {1.0, 0.1, 0.3},
                             .excitation = {{1.0, 0.0}},
                             .second = {0.0, 0.0, 0.6},
                             .bends = {{}, {{0.0, 0.0, 0.2}}, {}}};
  check_all(network, values, 50);
}

TEST_CASE("So are those of an absorber on a moving base that hits damped stops and rubs on the first mass",
          "[slow]") {
  Network network;
  network.masses = {"main", "absorber"};
  network.prescribed = {"base"};
  network.elements = {{"foot", ElementType::spring, base, first},
                      {"foot_damper", ElementType::damper, base, first},
                      {"absorber_spring", ElementType::spring, first, second},
                      {"absorber_damper", ElementType::damper, first, second},
                      stops(first, second, true),
                      stops(base, first, false),
                      {"guide", ElementType::coulomb, first, second}};
  network.elements[5].name = "base_stop";
  network.elements[6].has_static_force = true;
  network.excitations = {{ExcitationKind::motion, 0, 1}};
  const NetworkValues values{
      .omega = 0.93,
      .mass = {1.0, 0.1},
      .element = {1.0, 0.05, 0.09, 0.01, 0.3, 1.0, 0.01},
      .excitation = {{0.3, 0.4}},
      .second = {0.0, 0.0, 0.0, 0.0, 0.02, 0.1, 0.012},
      .bends = {{}, {}, {}, {}, {{0.6, 0.3, 0.02}, {0.7, 0.2, 0.03}}, {{0.5, 1.0, 0.1}}, {}}};
  check_all(network, values, 300);
}

TEST_CASE("Derivatives of a driven block on a belt, by the belt's speed too") {
  Network network;
  network.masses = {"block"};
  network.prescribed = {"belt"};
  network.elements = {{"spring", ElementType::spring, ground, first},
                      {"damper", ElementType::damper, ground, first},
                      {"friction", ElementType::coulomb, base, first},
                      {"drag", ElementType::damper, base, first},
                      {"leash", ElementType::jenkins, base, first}};
  network.elements[3].bends = {{1.0, &damper_bend}, {-1.0, &damper_bend}};
  network.excitations = {{ExcitationKind::belt, 0, 0}, {ExcitationKind::force, 0, 1}};
  for (const bool has_static_force : {false, true}) {
    network.elements[2].has_static_force = has_static_force;
    const NetworkValues values{.omega = 0.6,
                               .mass = {1.0},
                               .element = {1.0, 0.1, 0.3, 0.05, 0.4},
                               .excitation = {{0.2, 0.0}, {1.0, 0.0}},
                               .second = {0.0, 0.0, has_static_force ? 0.4 : 0.0, 0.0, 0.1},
                               .bends = {{}, {}, {}, {{0.3, 0.0, 0.1}, {0.25, 0.0, -0.02}}, {}}};
    check_all(network, values, 250);
  }
}

}  // namespace
}  // namespace frahm::periodic::bend_gradient_test
