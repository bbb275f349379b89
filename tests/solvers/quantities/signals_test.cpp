#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/quantities/quantity_table.hpp"
#include "solvers/response/gradient_check.hpp"
#include "solvers/response/periodic_response.hpp"
#include "tests/known_answers/random_network.hpp"
#include "tests/solvers/gradient_parameters.hpp"
#include "tests/solvers/nonstop/two_ways.hpp"

// Signals, combinations of coordinates, beside what they are made of.
namespace frahm::periodic::signals_test {
namespace {

using namespace mechanics;

constexpr double kSame = 1e-12;       // of a quantity that is the same thing twice
constexpr double kTwoWays = 1e-10;    // from phases and by shooting, as difference() takes it
constexpr double kIntegrated = 1e-8;  // of an integrated orbit, beside its size

struct Found {
  ResponseSummary summary;
  std::vector<Quantity> quantities;
  std::vector<double> values;

  double operator()(Measure measure, std::size_t index) const {
    return value_of(measure, index, quantities, values);
  }
};

Found solved(const Network& network, const NetworkValues& values, Path path) {
  Found found{{}, all_quantities(network), {}};
  found.values.resize(found.quantities.size());
  PeriodicResponse response(network, found.quantities, path);
  response.solve_row({&values, 1}, {&found.summary, 1}, found.values);
  return found;
}

Node mass(std::size_t index) {
  return {NodeKind::mass, index};
}
const Node support{NodeKind::prescribed, 0};

// Networks of 1 to 4 masses on a moving base with 0 to 3 contacts, which stick or not.
RandomNetwork drawn(unsigned seed) {
  std::mt19937 random(seed);
  RandomNetworkOptions options;
  options.masses = 1 + static_cast<int>(seed % 4);
  options.contacts = static_cast<int>(seed / 4 % 4);
  options.maxwell_elements = seed % 7 == 0 ? 1 : 0;
  options.orders = seed % 3 == 0 ? std::vector<int>{1, 2} : std::vector<int>{1};
  options.largest_friction = seed % 2 == 0 ? 0.1 : 1.0;
  return random_network(options, random);
}

bool sticks(const Found& found) {
  for (std::size_t i = 0; i < found.quantities.size(); ++i) {
    if (found.quantities[i].measure == Measure::stuck_fraction && found.values[i] > 0.0) return true;
  }
  return false;
}

// Of two values that are one, NaN among them.
bool are_same(double a, double b, double tolerance) {
  return a == b || (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= tolerance * std::abs(a);
}

bool follows_harmonic(Measure measure) {
  return measure == Measure::harmonic || measure == Measure::magnification ||
         measure == Measure::transmissibility;
}

// Every quantity of one coordinate, beside that of another. A mean is part of the peak, and may be its
// rounding; so is the component at the reference order where friction holds the mass, and what is told in
// proportion to it.
void check_alike(const Network& network, const Found& found, std::size_t a, std::size_t b, double tolerance) {
  const double of_peak = tolerance * found(Measure::peak, a), harmonic = found(Measure::harmonic, a);
  for (const QuantityRow& row : quantity_table()) {
    if (row.owner != Owner::mass) continue;
    const double own = found(row.measure, a), other = found(row.measure, b);
    INFO(describe({row.measure, b}, network, false).name << " " << own << " and " << other);
    double part = 0.0;
    if (row.measure == Measure::mean) part = of_peak;
    if (follows_harmonic(row.measure) && harmonic <= of_peak) part = of_peak * (own / harmonic);
    CHECK((are_same(own, other, tolerance) || std::abs(own - other) <= part));
  }
}

TEST_CASE("a signal of one mass is that mass in every quantity, from phases and by shooting") {
  int from_phases = 0, stuck = 0;
  for (unsigned seed = 0; seed < 120; ++seed) {
    INFO("seed " << seed);
    auto [network, values] = drawn(seed);
    const std::size_t masses = network.masses.size(), of = seed % masses;
    network.signals = {{"again", {{mass(of), 1.0}}}};
    for (const Path path : {Path::general, Path::fastest}) {
      const Found found = solved(network, values, path);
      if (found.summary.way == Way::event_phases) ++from_phases;
      if (sticks(found)) ++stuck;
      check_alike(network, found, of, masses, kSame);
    }
  }
  CHECK(from_phases > 60);
  CHECK(stuck > 30);
}

TEST_CASE("a signal along an element is the element's relative displacement") {
  for (unsigned seed = 0; seed < 60; ++seed) {
    INFO("seed " << seed);
    auto [network, values] = drawn(seed);
    for (const mechanics::Element& element : network.elements)
      network.signals.push_back({"along_" + element.name, element.along});
    for (const Path path : {Path::general, Path::fastest}) {
      const Found found = solved(network, values, path);
      for (std::size_t e = 0; e < network.elements.size(); ++e) {
        INFO(network.elements[e].name);
        const std::size_t signal = network.masses.size() + e;
        CHECK(are_same(found(Measure::peak, signal), found(Measure::stroke, e), kSame));
        CHECK(are_same(found(Measure::phase, signal), found(Measure::element_phase, e), kSame));
      }
    }
  }
}

// Two masses, of which the second is three times the first in all, move as one: between them is rounding
// alone.
TEST_CASE("a relative motion that is rounding has no phase, from phases and by shooting") {
  using mechanics::ElementType;
  const Node ground{};
  Network network{
      .masses = {"small", "large"},
      .elements = {{"k1", ElementType::spring, ground, mass(0)},
                   {"k2", ElementType::spring, ground, mass(1)},
                   {"c1", ElementType::damper, ground, mass(0)},
                   {"c2", ElementType::damper, ground, mass(1)},
                   {"f1", ElementType::coulomb, ground, mass(0)},
                   {"f2", ElementType::coulomb, ground, mass(1)},
                   {"between", ElementType::spring, mass(0), mass(1)}},
      .excitations = {{mechanics::ExcitationKind::force, 0, 1}, {mechanics::ExcitationKind::force, 1, 1}}};
  network.signals = {{"drift", {{mass(1), 1.0}, {mass(0), -1.0}}}};
  constexpr std::size_t drift = 2, spring = 6;
  for (const double friction : {0.0, 0.03, 0.6}) {
    for (const double omega : {0.3, 0.7, 0.95, 1.3, 2.1}) {
      const NetworkValues values{
          .omega = omega,
          .mass = {0.7, 2.1},
          .element = {1.1, 3.3, 0.1, 0.3, friction, 3.0 * friction, 0.37},
          .excitation = {{1.0, 0.2}, {3.0, 0.2}},
      };
      for (const Path path : {Path::general, Path::fastest}) {
        INFO("friction " << friction << " omega " << omega << " path " << static_cast<int>(path));
        const Found found = solved(network, values, path);
        CHECK(std::isnan(found(Measure::phase, drift)));
        CHECK(std::isnan(found(Measure::element_phase, spring)));
        CHECK_FALSE(std::isnan(found(Measure::phase, 0)));
      }
    }
  }
}

TEST_CASE("a mass that stands still while others move has no phase, from phases and by shooting") {
  using mechanics::ElementType;
  const Node ground{};
  Network network{.masses = {"moves", "light", "heavy"}, .elements = {}};
  for (std::size_t i = 0; i < 3; ++i) {
    network.elements.push_back({"k" + std::to_string(i), ElementType::spring, ground, mass(i)});
    network.elements.push_back({"c" + std::to_string(i), ElementType::damper, ground, mass(i)});
  }
  network.elements.push_back({"f", ElementType::coulomb, ground, mass(0)});
  network.excitations = {{mechanics::ExcitationKind::force, 0, 1}};
  const NetworkValues values{.omega = 0.9,
                             .mass = {1.0, 0.03, 40.0},
                             .element = {1.3, 0.1, 0.02, 0.01, 70.0, 3.0, 0.05},
                             .excitation = {{1.0, 0.2}}};
  for (const Path path : {Path::general, Path::fastest}) {
    INFO("path " << static_cast<int>(path));
    const Found found = solved(network, values, path);
    CHECK_FALSE(std::isnan(found(Measure::phase, 0)));
    CHECK(std::isnan(found(Measure::phase, 1)));
    CHECK(std::isnan(found(Measure::phase, 2)));
  }
}

// A mass with friction in a chain, on a base that moves slowly: relative to it next to nothing moves.
TEST_CASE("a displacement relative to the base is as exact where it is a small part of what it is made of") {
  Network network;
  network.masses = {"roof"};
  network.prescribed = {"base"};
  network.elements = {{"spring", ElementType::spring, support, mass(0)},
                      {"damper", ElementType::damper, support, mass(0)}};
  network.excitations = {{ExcitationKind::motion, 0, 1}};
  network.signals = {{"relative", {{mass(0), 1.0}, {support, -1.0}}}};
  const double r = 0.01, zeta = 0.05;
  const NetworkValues values{.omega = r, .mass = {1.0}, .element = {1.0, 2.0 * zeta}, .excitation = {{1.0}}};
  // x - y = r^2 / |1 - r^2 + 2 i zeta r| of the base's amplitude; its rms is 1/sqrt(2) of that.
  const double amplitude = r * r / std::hypot(1.0 - r * r, 2.0 * zeta * r);
  constexpr double kRoundingOfParts = 1e-10;  // 1e-14 of the base's motion, of which r^2 is left
  constexpr double kOfAccelerations = 1e-6;   // 1e-14 of those of the springs, of which r^4 is left
  for (const Path path : {Path::general, Path::fastest}) {
    const Found found = solved(network, values, path);
    CHECK(are_same(amplitude, found(Measure::peak, 1), kRoundingOfParts));
    CHECK(are_same(amplitude, found(Measure::harmonic, 1), kRoundingOfParts));
    CHECK(are_same(amplitude, found(Measure::transmissibility, 1), kRoundingOfParts));
    CHECK(are_same(amplitude / std::numbers::sqrt2, found(Measure::rms, 1), kRoundingOfParts));
    CHECK(are_same(r * r * amplitude, found(Measure::acceleration_peak, 1), kOfAccelerations));
    CHECK(std::isnan(found(Measure::magnification, 1)));  // at rest on the base it would not move
  }
}

// The absolute motion of a mass whose coordinate is relative to the base: base + mass.
TEST_CASE("signals have the same values from phases and by shooting, and leave all others as they are") {
  int from_phases = 0;
  for (unsigned seed = 0; seed < 120; ++seed) {
    INFO("seed " << seed);
    const auto [plain, values] = drawn(seed);
    Network network = plain;
    mechanics::Direction any{{support, 0.7}};
    for (std::size_t i = 0; i < network.masses.size(); ++i) any.push_back({mass(i), i % 2 == 0 ? 1.3 : -0.4});
    network.signals = {{"any", any}};
    const Found general = solved(network, values, Path::general);
    const Found fastest = solved(network, values, Path::fastest);
    for (const Path path : {Path::general, Path::fastest}) {
      const Found without = solved(plain, values, path);
      const Found& with = path == Path::general ? general : fastest;
      for (std::size_t i = 0; i < without.quantities.size(); ++i) {
        const auto [measure, index, side] = without.quantities[i];
        INFO(describe(without.quantities[i], plain, false).name);
        CHECK(are_same(without.values[i], with(measure, index), 0.0));
      }
    }
    if (fastest.summary.way != Way::event_phases) continue;
    ++from_phases;
    for (std::size_t i = 0; i < general.quantities.size(); ++i) {
      const auto [measure, index, side] = general.quantities[i];
      if (row_of(measure).owner != Owner::mass || index != network.masses.size()) continue;
      INFO(row_of(measure).suffix << " " << general.values[i] << " and " << fastest.values[i]);
      CHECK(difference(i, general.quantities, general.values, fastest.values) <= kTwoWays);
    }
  }
  CHECK(from_phases > 60);
}

TEST_CASE("a signal's derivatives are those of its mass, and of differences where the base has a share") {
  constexpr double kDifference = 1e-6;  // of a difference, relative
  constexpr double kZero = 1e-13;       // rounding of a derivative that is zero
  int compared = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    INFO("seed " << seed);
    auto [network, values] = drawn(seed);
    const std::size_t masses = network.masses.size(), of = seed % masses;
    network.signals = {{"again", {{mass(of), 1.0}}}, {"relative", {{mass(of), 1.0}, {support, -1.0}}}};
    std::vector<Quantity> quantities;
    for (const QuantityRow& row : quantity_table()) {
      if (row.owner != Owner::mass) continue;
      for (const std::size_t coordinate : {of, masses, masses + 1})
        quantities.push_back({row.measure, coordinate});
    }
    std::vector<CheckedParameter> parameters;
    for (const NamedParameter& named : all_parameters(network, values)) parameters.push_back(named.parameter);
    const GradientCheck check = check_gradient(network, quantities, values, parameters);
    if (!check.reason.empty()) continue;
    const auto peak = static_cast<std::size_t>(std::ranges::find(quantities, Quantity{Measure::peak, of}) -
                                               quantities.begin());
    for (std::size_t d = 0; d < parameters.size(); ++d) {
      for (std::size_t i = 0; i < quantities.size(); i += 3) {
        INFO(describe(quantities[i], network, false).name << " by parameter " << d);
        const DerivativeCheck &own = check.columns[d][i], &again = check.columns[d][i + 1],
                              &relative = check.columns[d][i + 2];
        CHECK(own.why_none == again.why_none);
        // A mean that does not change is the rounding of the peak's change.
        const double of_peak = std::abs(check.columns[d][peak].exact);
        CHECK((are_same(own.exact, again.exact, kSame) ||
               std::abs(own.exact - again.exact) <= kSame * of_peak));
        if (!relative.why_none.empty() || std::isnan(relative.difference)) continue;
        const double apart = std::abs(relative.exact - relative.difference);
        INFO(relative.exact << " and " << relative.difference << " +- " << relative.uncertainty);
        CHECK(apart <= kDifference * std::abs(relative.exact) + 10.0 * relative.uncertainty + kZero);
        ++compared;
      }
    }
  }
  CHECK(compared > 1000);
}

TEST_CASE("under the arctan law a signal of one mass is that mass, and one along a spring its stroke") {
  Network network;
  network.masses = {"first", "roof"};
  network.prescribed = {"base"};
  network.elements = {{"lower", ElementType::spring, support, mass(0)},
                      {"upper", ElementType::spring, mass(0), mass(1)},
                      {"damper", ElementType::damper, support, mass(0)},
                      {"brace", ElementType::coulomb, mass(0), mass(1), ForceLaw::arctan}};
  network.excitations = {{ExcitationKind::motion, 0, 1}};
  network.signals = {{"again", {{mass(1), 1.0}}}, {"drift", network.elements[1].along}};
  const NetworkValues values{.omega = 0.7,
                             .mass = {1.0, 0.5},
                             .element = {1.0, 0.8, 0.1, 0.1},
                             .excitation = {{1.0}},
                             .smooth = {{}, {}, {}, {.slope = 50.0}}};
  const Found found = solved(network, values, Path::fastest);
  REQUIRE(found.summary.status == Status::ok);
  check_alike(network, found, 1, 2, kSame);
  CHECK(are_same(found(Measure::peak, 3), found(Measure::stroke, 1), kSame));
  // By its history: the mean square over a period, sampled evenly.
  PeriodicResponse response(network, {});
  response.set_values(values);
  response.solve();
  const History history = response.history(phases_of_a_period(513));
  const auto place = std::ranges::find(history.names, "drift_displacement") - history.names.begin();
  const std::vector<double>& x = history.columns[static_cast<std::size_t>(place)];
  double square = 0.0;
  for (std::size_t i = 0; i < 512; ++i) square += x[i] * x[i] / 512.0;
  CHECK(are_same(std::sqrt(square), found(Measure::rms, 3), kIntegrated));
}

TEST_CASE("a history has displacement, velocity and acceleration of each signal") {
  auto [network, values] = drawn(5);
  const std::size_t masses = network.masses.size();
  REQUIRE(masses == 2);
  network.signals = {{"drift", {{mass(1), 1.0}, {mass(0), -1.0}}}};
  PeriodicResponse response(network, {});
  response.set_values(values);
  response.solve();
  const History history = response.history(phases_of_a_period(65));
  const auto column = [&](const std::string& name) -> const std::vector<double>& {
    const auto place = std::ranges::find(history.names, name);
    REQUIRE(place != history.names.end());
    return history.columns[static_cast<std::size_t>(place - history.names.begin())];
  };
  for (const std::string what : {"_displacement", "_velocity", "_acceleration"}) {
    for (std::size_t i = 0; i < history.time.size(); ++i) {
      const double parts = column("m1" + what)[i] - column("m0" + what)[i];
      CHECK(std::abs(column("drift" + what)[i] - parts) <= 1e-13 * (1.0 + std::abs(parts)));
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::signals_test
