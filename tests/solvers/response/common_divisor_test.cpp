#include "solvers/response/common_divisor.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "solvers/exact/exact_solver.hpp"
#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/arctan.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Excitations whose orders have a common divisor.
namespace frahm::periodic::common_divisor_test {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;
using namespace mechanics;

constexpr double kSame = 1e-10;
constexpr double kRounding = 1e-11;  // of residuals and bounds, which are nothing else

// Two masses with every kind of element, the first shaken by two forces of these orders.
Network shaken(int first, int second, int reference) {
  const Node ground{}, a{NodeKind::mass, 0}, b{NodeKind::mass, 1};
  return {.masses = {"a", "b"},
          .elements = {{"k1", ElementType::spring, ground, a},
                       {"c1", ElementType::damper, ground, a},
                       {"guide", ElementType::coulomb, ground, a},
                       {"link", ElementType::hysteretic, a, b},
                       {"mount", ElementType::maxwell, a, b},
                       {"inerter", ElementType::inerter, ground, b}},
          .excitations = {{ExcitationKind::force, 0, first}, {ExcitationKind::force, 0, second}},
          .reference_order = reference};
}

NetworkValues shaken_values(double omega) {
  return {.omega = omega,
          .mass = {1.0, 0.6},
          .element = {1.0, 0.06, 0.25, 0.8, 0.3, 0.2},
          .excitation = {{1.0, 0.4}, {0.7, -1.1}},
          .second = {0.0, 0.0, 0.0, 0.1, 0.5, 0.0}};
}

// What a quantity of the shorter period is for g of them.
double of_whole_period(Measure measure, double value, int g) {
  if (measure == Measure::floquet_radius) return std::pow(value, g);
  if (measure == Measure::peak_phase) return value / g;
  const bool is_missing_count = value == -1.0;  // under the arctan law
  return is_of_a_period(measure) && !is_missing_count ? value * g : value;
}

// A contact that slides and stops has the regime of its stops in the whole period.
double regime_of_whole_period(Responses& at_part, const std::string& contact, int g) {
  const double stops = g * at_part[contact + "_stops"], regime = at_part[contact + "_regime"];
  if (!(stops > 0.0) || regime == static_cast<double>(Regime::stuck)) return regime;
  return static_cast<double>(stops <= 2.0 ? Regime::one_stop : Regime::multi_stop);
}

// Every quantity of `whole` is that of `part`, whose orders are a g-th at g times the frequency.
void check_same(const Network& whole, const NetworkValues& whole_values, const Network& part,
                const NetworkValues& part_values, int g) {
  Responses at_whole(whole), at_part(part);
  at_whole.solve(whole_values);
  at_part.solve(part_values);
  REQUIRE(at_part["status"] == 1.0);
  for (const Quantity& quantity : all_quantities(whole)) {
    const std::string name = describe(quantity, whole, false).name;
    INFO(name << " of orders with the divisor " << g);
    const double expected = quantity.measure == Measure::regime
                                ? regime_of_whole_period(at_part, whole.elements[quantity.index].name, g)
                                : of_whole_period(quantity.measure, at_part[name], g);
    const double found = at_whole[name];
    if (std::isnan(expected)) {
      CHECK(std::isnan(found));
    } else {
      CHECK_THAT(found, WithinRel(expected, kSame) || WithinAbs(expected, kRounding));
    }
  }
}

TEST_CASE("The common divisor is that of all orders above zero, and a crank counts as its first") {
  CHECK(common_divisor(shaken(4, 6, 4)) == 2);
  CHECK(common_divisor(shaken(2, 3, 2)) == 1);
  CHECK(common_divisor(shaken(30, 30, 30)) == 30);
  CHECK(common_divisor(shaken(30, 0, 30)) == 30);
  CHECK(common_divisor(shaken(0, 0, 1)) == 1);
  Network driven = shaken(6, 4, 4);
  driven.prescribed = {"slider"};
  driven.excitations.push_back({.kind = ExcitationKind::crank, .node = 0, .even_orders = 5});
  CHECK(common_divisor(driven) == 1);
}

TEST_CASE("Order 30 alone is order 1 at 30 times the frequency, in every quantity") {
  for (const double r : {0.35, 0.9, 1.6}) {
    Network thirtieth = single_mass();
    thirtieth.excitations[0].order = thirtieth.reference_order = 30;
    check_same(thirtieth, single_mass_values(r / 30.0, 0.05, 0.3), single_mass(),
               single_mass_values(r, 0.05, 0.3), 30);
  }
}

TEST_CASE("Orders 4 and 6 are orders 2 and 3 at twice the frequency, in every quantity") {
  for (const double omega : {0.25, 0.45}) {
    check_same(shaken(4, 6, 4), shaken_values(omega), shaken(2, 3, 2), shaken_values(2.0 * omega), 2);
    check_same(shaken(4, 6, 6), shaken_values(omega), shaken(2, 3, 3), shaken_values(2.0 * omega), 2);
  }
}

// A mass that sticks once in each half of a period of order 1 (Den Hartog) does so twice under order 2.
TEST_CASE("Stops and regime belong to the same period, that of the fundamental") {
  const double r = 0.6, zeta = 0.05, f = 0.7;
  REQUIRE(one_stop_response(r, zeta, f).valid());
  Network second = single_mass();
  second.excitations[0].order = second.reference_order = 2;
  Responses first_order(single_mass()), second_order(second);
  first_order.solve(single_mass_values(r, zeta, f));
  second_order.solve(single_mass_values(r / 2.0, zeta, f));
  CHECK(first_order["friction_stops"] == 2.0);
  CHECK(first_order["friction_regime"] == static_cast<double>(Regime::one_stop));
  CHECK(second_order["friction_stops"] == 4.0);
  CHECK(second_order["friction_regime"] == static_cast<double>(Regime::multi_stop));
  // Asked alone, as the borders of a map ask for it, and of a row.
  PeriodicResponse alone(second, {{Measure::regime, 2}, {Measure::peak, 0}});
  const std::vector<NetworkValues> row{single_mass_values(r / 2.0, zeta, f),
                                       single_mass_values(0.45, zeta, f)};
  std::vector<ResponseSummary> found(2);
  std::vector<double> values(4);
  alone.solve_row(row, found, values);
  CHECK(values[0] == static_cast<double>(Regime::multi_stop));
  CHECK_THAT(values[1], WithinRel(one_stop_response(r, zeta, f).amplitude, kSame));
  CHECK_THAT(values[3], WithinRel(classical_amplitude(0.9, zeta, f), kSame));
}

TEST_CASE("The arctan law's orders are divided too") {
  Network second = under_arctan(single_mass());
  second.excitations[0].order = second.reference_order = 2;
  check_same(second, with_slope(single_mass_values(0.4, 0.05, 0.3), 50.0), under_arctan(single_mass()),
             with_slope(single_mass_values(0.8, 0.05, 0.3), 50.0), 2);
}

TEST_CASE("Divided or not, a response is the same") {
  constexpr double kClose = 1e-8;
  const Network network = shaken(4, 6, 4);
  const std::vector<Quantity> quantities = all_quantities(network);
  const NetworkValues values = shaken_values(0.3);
  const auto undivided = make_exact_solver(network, quantities);
  undivided->set_values(values);
  undivided->solve();
  std::vector<double> expected(quantities.size());
  undivided->quantities(expected);
  Responses found(network);
  found.solve(values);
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const Measure measure = quantities[i].measure;
    // How it was found differs, and of peaks that repeat either may be the first.
    if (measure == Measure::residual || measure == Measure::error_bound ||
        measure == Measure::newton_iterations || measure == Measure::energy_balance ||
        measure == Measure::peak_phase)
      continue;
    const std::string name = describe(quantities[i], network, false).name;
    INFO(name);
    if (std::isnan(expected[i])) {
      CHECK(std::isnan(found[name]));
    } else {
      CHECK_THAT(found[name], WithinRel(expected[i], kClose) || WithinAbs(expected[i], kClose));
    }
  }
  const std::vector<double> phases = phases_of_a_period(33);
  const History whole = undivided->history(phases, SliderForces::summed),
                divided = found.response().history(phases);
  for (std::size_t c = 0; c < whole.columns.size(); ++c) {
    for (std::size_t i = 0; i < phases.size(); ++i) {
      INFO(whole.names[c] << " at " << phases[i]);
      CHECK_THAT(divided.time[i], WithinAbs(whole.time[i], 1e-12));
      CHECK_THAT(divided.columns[c][i], WithinAbs(whole.columns[c][i], kClose));
    }
  }
  ObservedMotion seen, expected_seen;
  const std::vector<double> times{0.0, 3.7, 40.0};
  const std::vector<Observed> observed{{0, 0}, {1, 1}};
  undivided->observe(times, observed, {}, expected_seen);
  found.response().observe(times, observed, {}, seen);
  CHECK((seen.values - expected_seen.values).cwiseAbs().maxCoeff() < kClose);
}

TEST_CASE("Stretches cover the period that was asked for, one after the other") {
  PeriodicResponse response(shaken(4, 6, 4), {});
  response.set_values(shaken_values(0.3));
  response.solve();
  const std::vector<Stretch> stretches = response.stretches();
  REQUIRE(!stretches.empty());
  CHECK(stretches.size() % 2 == 0);
  double covered = 0.0;
  for (const Stretch& stretch : stretches) covered += stretch.length;
  CHECK_THAT(covered, WithinRel(2.0 * std::numbers::pi, 1e-12));
  CHECK(std::is_sorted(stretches.begin(), stretches.end(),
                       [](const Stretch& a, const Stretch& b) { return a.start < b.start; }));
  CHECK(stretches.back().start < 2.0 * std::numbers::pi);
}

TEST_CASE("At a reference order that the divisor does not divide there is no component") {
  Responses responses(shaken(4, 6, 5)), at_order(shaken(4, 6, 4));
  NetworkValues values = shaken_values(0.3);
  responses.solve(values);
  CHECK(responses["status"] == 1.0);
  CHECK(responses["a_harmonic"] == 0.0);
  for (const char* name :
       {"a_phase", "k1_phase", "a_magnification", "a_transmissibility", "force_transmissibility"}) {
    INFO(name);
    CHECK(std::isnan(responses[name]));
  }
  // The loss factor holds at 5 omega all the same.
  values.hysteretic_omega = 5.0 * values.omega;
  at_order.solve(values);
  for (const char* name : {"a_peak", "b_rms", "guide_energy", "link_energy", "mount_force_peak"}) {
    INFO(name);
    CHECK_THAT(responses[name], WithinRel(at_order[name], kSame));
  }
}

TEST_CASE("Gradients of divided orders agree with differences, the loss factor's frequency moving along") {
  constexpr double kAgree = 1e-6;
  for (const int reference : {4, 5}) {
    const Network network = shaken(4, 6, reference);
    const NetworkValues values = shaken_values(0.3);
    std::vector<Quantity> quantities;
    for (const Quantity& quantity : all_quantities(network)) {
      if (is_differentiable(quantity.measure)) quantities.push_back(quantity);
    }
    std::vector<CheckedParameter> parameters;
    for (const NamedParameter& named : all_parameters(network, values)) parameters.push_back(named.parameter);
    const GradientCheck check = check_gradient(network, quantities, values, parameters);
    REQUIRE(check.reason.empty());
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      for (std::size_t i = 0; i < quantities.size(); ++i) {
        const DerivativeCheck& each = check.columns[p][i];
        INFO(describe(quantities[i], network, false).name << " by parameter " << p << ", reference order "
                                                          << reference);
        if (std::isnan(each.exact)) {
          if (quantities[i].measure == Measure::phase) CHECK(!each.why_none.empty());
          continue;
        }
        const double tolerance = std::max(kAgree * (1.0 + std::abs(each.exact)), 10.0 * each.uncertainty);
        CHECK_THAT(each.difference, WithinAbs(each.exact, tolerance));
      }
    }
  }
}

// A search over the thirty periods of order 30 ended at a rest position that is not the one of least energy.
TEST_CASE("A mass that sticks under order 30 alone rests where it does under order 1") {
  const Node ground{}, a{NodeKind::mass, 0}, b{NodeKind::mass, 1};
  const Network network{.masses = {"a", "b"},
                        .elements = {{"k1", ElementType::spring, ground, a},
                                     {"c1", ElementType::damper, ground, a},
                                     {"k2", ElementType::spring, a, b},
                                     {"c2", ElementType::damper, a, b},
                                     {"g", ElementType::coulomb, ground, a}},
                        .excitations = {{ExcitationKind::force, 1, 30}},
                        .reference_order = 30};
  Responses responses(network);
  responses.solve({.omega = 0.01,
                   .mass = {3.0, 2.8},
                   .element = {0.4, 0.0238, 2.2, 0.2, 3.0},
                   .excitation = {{1.0, 4.0}}});
  CHECK(responses["status"] == 1.0);
  CHECK_THAT(responses["a_peak"], WithinAbs(0.0, 1e-12));
  CHECK_THAT(responses["b_peak"], WithinAbs(0.513104, 1e-6));
}

}  // namespace
}  // namespace frahm::periodic::common_divisor_test
