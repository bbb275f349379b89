// Periodic responses of masses that no spring holds: in closed form, and drawn at random against an
// independent integration.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solvers/orbits/orbit.hpp"
#include "solvers/response/gradient_check.hpp"
#include "tests/known_answers/exponential_integrator.hpp"
#include "tests/known_answers/random_free_network.hpp"
#include "tests/known_answers/single_mass.hpp"
#include "tests/solvers/gradient_parameters.hpp"

namespace frahm::periodic::free_orbits_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel, Catch::Matchers::Contains;
using namespace mechanics;

constexpr double kExact = 1e-10;  // relative; the figure, most answers come to 1e-13
constexpr double kPi = std::numbers::pi;
constexpr Node kGround{}, kFirst{NodeKind::mass, 0}, kSecond{NodeKind::mass, 1},
    kPlane{NodeKind::prescribed, 0};

struct Answer {
  ResponseSummary summary;
  std::vector<double> values;
};

Answer answer(const Network& network, const NetworkValues& values, const std::vector<std::string>& names) {
  std::vector<Quantity> quantities;
  for (const std::string& name : names) {
    const auto found = find_quantity(name, network);
    INFO(name);
    REQUIRE(found);
    quantities.push_back(*found);
  }
  PeriodicResponse response(network, quantities);
  response.set_values(values);
  Answer result{response.solve(), std::vector<double>(names.size())};
  response.quantities(result.values);
  return result;
}

// A block on a plane that is shaken with Y cos(omega t).
Network block_on_plane() {
  return {.masses = {"block"},
          .prescribed = {"plane"},
          .elements = {{"friction", ElementType::coulomb, kPlane, kFirst}},
          .excitations = {{ExcitationKind::motion, 0, 1}}};
}

// Where friction is too weak to hold it, the block's velocity is a triangle of slopes +-F/m (DESIGN of a
// sliding block: eta = F/(m A), A = Y omega^2; it never stops for eta <= 1/sqrt(1 + pi^2/4)).
TEST_CASE("A block on a shaken plane slides, stops or rides as the ratio of friction to inertia says") {
  const double m = 2.0, omega = 3.0, Y = 0.1, A = Y * omega * omega;
  const std::vector<std::string> names{"block_amplitude", "block_velocity_peak", "friction_stops",
                                       "block_drift",     "floquet_radius",      "energy_balance",
                                       "friction_energy", "error_bound",         "block_mean"};
  const double never_stops = 1.0 / std::sqrt(1.0 + kPi * kPi / 4.0);
  for (const double eta : {0.1, 0.3, 0.53, never_stops - 1e-6, never_stops + 1e-6, 0.6, 0.8, 0.99, 1.2}) {
    const double a = eta * A;
    const Answer found = answer(
        block_on_plane(), {.omega = omega, .mass = {m}, .element = {m * a}, .excitation = {{Y, 0.0}}}, names);
    INFO("eta " << eta << " " << found.summary.reason);
    CHECK(has_response(found.summary.status));
    CHECK(found.values[3] == 0.0);
    CHECK(found.values[5] < 1e-12);
    CHECK(std::abs(found.values[8]) < 1e-15);
    if (eta < never_stops) {
      CHECK_THAT(found.values[0], WithinRel(a * kPi * kPi / (8.0 * omega * omega), kExact));
      CHECK_THAT(found.values[1], WithinRel(a * kPi / (2.0 * omega), kExact));
      CHECK(found.values[2] == 0.0);
      CHECK(found.values[4] < 1.0);
      CHECK(found.values[7] < 1e-9);
    } else if (eta < 1.0) {
      // It is let go at sin(theta) = eta and meets the plane again at theta + x:
      //   cos(theta) - eta x = cos(theta + x).
      const double theta = std::asin(eta);
      double low = 1e-3, high = kPi;  // x
      const auto gap = [&](double x) { return std::cos(theta) - eta * x - std::cos(theta + x); };
      for (int i = 0; i < 200; ++i) (gap(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
      const double slid =
          Y * omega / omega *
          std::abs(low * std::cos(theta) - 0.5 * eta * low * low - (std::sin(theta + low) - std::sin(theta)));
      CHECK(found.values[2] == 2.0);
      CHECK_THAT(found.values[6], WithinRel(2.0 * m * a * slid, 1e-9));
    } else {
      CHECK_THAT(found.values[0], WithinRel(Y, kExact));
      CHECK(found.values[2] == 0.0);
      CHECK(found.values[6] == 0.0);
    }
  }
}

// On a plane that is shaken with A cos(omega t) friction mu m and a constant load p m give the same drift
// A/omega^2 in all units.
TEST_CASE("What friction lets a constant load carry on has the same digits in all units") {
  constexpr double kDigits = 1e-12;  // relative
  const auto drift = [](double m, double omega) {
    Network network = block_on_plane();
    network.excitations.push_back({ExcitationKind::force, 0, 0});
    const auto found = answer(network,
                              {.omega = omega,
                               .mass = {m},
                               .element = {4.0 * m},
                               .excitation = {{13.0 / (omega * omega), 0.0}, {-0.15 * m, 0.0}}},
                              {"block_drift", "energy_balance"});
    CHECK(found.summary.status == Status::ok);
    CHECK(found.values[1] < 1e-12);
    return found.values[0] * omega * omega;
  };
  const double one = drift(1.0, 1.0);
  CHECK_THAT(one, WithinRel(-4.209275771384515, kDigits));  // its closed form, found beside the program
  for (const auto& [m, omega] :
       {std::pair(2.0, 1.0), std::pair(2e4, 100.0), std::pair(2e5, 300.0), std::pair(2e7, 100.0)})
    CHECK_THAT(drift(m, omega), WithinRel(one, kDigits));
}

TEST_CASE("A free shaft twists by T/J1/(k (1/J1 + 1/J2) - omega^2), its momentum zero on the mean") {
  const double J1 = 2.0, J2 = 0.7, k = 50.0, omega = 4.0, T = 3.0;
  Network shaft{.masses = {"motor", "load"},
                .elements = {{"shaft", ElementType::spring, kFirst, kSecond}},
                .excitations = {{ExcitationKind::force, 0, 1}},
                .signals = {{"twist", between(kFirst, kSecond)}}};
  const Answer found =
      answer(shaft, {.omega = omega, .mass = {J1, J2}, .element = {k}, .excitation = {{T, 0.3}}},
             {"twist_amplitude", "motor_amplitude", "motor_mean", "load_drift", "load_mean_velocity",
              "natural_frequency_1", "natural_frequency_2"});
  INFO(found.summary.reason);
  CHECK(found.summary.status == Status::ok);
  const double twist = T / J1 / (k * (1.0 / J1 + 1.0 / J2) - omega * omega);
  CHECK_THAT(found.values[0], WithinRel(twist, kExact));
  // J1 q1'' = T cos - k twist
  CHECK_THAT(found.values[1], WithinRel(std::abs(T - k * twist) / (J1 * omega * omega), kExact));
  CHECK(std::abs(found.values[2]) < 1e-13);
  CHECK(found.values[3] == 0.0);
  CHECK(found.values[4] == 0.0);
  CHECK(found.values[5] == 0.0);
  CHECK_THAT(found.values[6], WithinRel(std::sqrt(k * (1.0 / J1 + 1.0 / J2)), kExact));
}

TEST_CASE("A mass on a damper drifts with f0/c, and swings about its drift as if it did not") {
  const double m = 2.0, c = 0.7, f0 = 0.4, P = 3.0, omega = 1.9;
  Network network{.masses = {"x"},
                  .elements = {on_the_mass("damper", ElementType::damper)},
                  .excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::force, 0, 0}}};
  const double swing = P / (omega * std::hypot(m * omega, c));
  for (const double constant : {f0, 0.0}) {
    const Answer found = answer(
        network, {.omega = omega, .mass = {m}, .element = {c}, .excitation = {{P, 0.0}, {constant, 0.0}}},
        {"x_amplitude", "x_drift", "x_mean_velocity", "x_velocity_peak", "floquet_radius", "energy_input",
         "damper_energy", "damper_stroke", "x_rms", "x_harmonic", "x_mean"});
    const double T = 2.0 * kPi / omega;
    INFO(found.summary.reason);
    CHECK(found.summary.status == Status::ok);
    CHECK_THAT(found.values[0], WithinRel(swing, kExact));
    CHECK_THAT(found.values[1], WithinAbs(constant / c * T, kExact));
    CHECK_THAT(found.values[2], WithinAbs(constant / c, kExact));
    CHECK_THAT(found.values[3], WithinRel(constant / c + omega * swing, kExact));
    CHECK_THAT(found.values[4], WithinRel(std::exp(-c / m * T), kExact));
    const double loss = c * T * (constant * constant / (c * c) + 0.5 * omega * omega * swing * swing);
    CHECK_THAT(found.values[5], WithinRel(loss, kExact));
    CHECK_THAT(found.values[6], WithinRel(loss, kExact));
    CHECK_THAT(found.values[7], WithinRel(swing, kExact));
    CHECK_THAT(found.values[8], WithinRel(swing / std::sqrt(2.0), kExact));
    CHECK_THAT(found.values[9], WithinRel(swing, kExact));
    CHECK(std::abs(found.values[10]) < 1e-12);
  }
}

TEST_CASE("Two masses that rub on each other alone have a momentum of zero mean") {
  const double m1 = 2.0, m2 = 0.5, P = 3.0, omega = 1.9;
  const Network network{.masses = {"a", "b"},
                        .elements = {{"friction", ElementType::coulomb, kFirst, kSecond}},
                        .excitations = {{ExcitationKind::force, 0, 1}}};
  const std::vector<std::string> names{"a_amplitude", "b_amplitude", "b_drift", "friction_stops", "b_mean"};
  const auto solve = [&](double F) {
    return answer(network, {.omega = omega, .mass = {m1, m2}, .element = {F}, .excitation = {{P, 1.1}}},
                  names);
  };
  const Answer stuck = solve(2.0);
  CHECK_THAT(stuck.values[0], WithinRel(P / ((m1 + m2) * omega * omega), kExact));
  CHECK_THAT(stuck.values[1], WithinRel(P / ((m1 + m2) * omega * omega), kExact));
  const double F = 0.05;
  const Answer slides = solve(F);
  CHECK(slides.summary.status == Status::ok);
  CHECK_THAT(slides.values[1], WithinRel(F / m2 * kPi * kPi / (8.0 * omega * omega), kExact));
  CHECK(slides.values[2] == 0.0);
  CHECK(slides.values[3] == 0.0);
  CHECK(std::abs(slides.values[4]) < 1e-13);
}

TEST_CASE("Loads that friction holds singly may run away together") {
  // b on the ground holds 1, a on b holds 2.
  const Network network{
      .masses = {"a", "b"},
      .elements = {{"upper", ElementType::coulomb, kFirst, kSecond},
                   {"lower", ElementType::coulomb, kGround, kSecond}},
      .excitations = {
          {ExcitationKind::force, 0, 0}, {ExcitationKind::force, 1, 0}, {ExcitationKind::force, 0, 1}}};
  const auto status = [&](double a, double b) {
    return answer(
        network,
        {.omega = 1.0, .mass = {1.0, 1.0}, .element = {2.0, 1.0}, .excitation = {{a, 0}, {b, 0}, {0.01, 0}}},
        {"a_amplitude"});
  };
  CHECK(has_response(status(0.9, 0.0).summary.status));
  CHECK(has_response(status(0.0, 0.9).summary.status));
  const Answer away = status(0.9, 0.9);
  CHECK(away.summary.status == Status::unbounded);
  CHECK_THAT(away.summary.reason, Contains("\"a\", \"b\"") && Contains("1.8") && Contains("at most 1;"));
  CHECK(std::isnan(away.values[0]));
  CHECK(status(2.5, -2.0).summary.status == Status::unbounded);  // a alone
  CHECK(has_response(status(-1.9, 2.8).summary.status));
}

// A conveyor: its plane moves with two orders, so that the part on it is carried along.
Network conveyor() {
  return {.masses = {"part", "rider"},
          .prescribed = {"trough"},
          .elements = {{"friction", ElementType::coulomb, kPlane, kFirst},
                       {"spring", ElementType::spring, kFirst, kSecond},
                       {"damper", ElementType::damper, kFirst, kSecond}},
          .excitations = {
              {ExcitationKind::motion, 0, 1}, {ExcitationKind::motion, 0, 2}, {ExcitationKind::force, 0, 0}}};
}
NetworkValues conveyor_values() {
  return {.omega = 3.0,
          .mass = {2.0, 0.4},
          .element = {4.0, 9.0, 0.3},
          .excitation = {{0.3, 0.0}, {0.09, 0.9}, {0.2, 0.0}}};
}

TEST_CASE("What a period adds to a conveyed part, and all else, has exact derivatives") {
  const Network network = conveyor();
  const std::vector<std::string> names{
      "part_drift",    "part_mean_velocity", "part_amplitude",      "part_rms",           "part_phase",
      "rider_peak",    "rider_drift",        "rider_velocity_peak", "friction_energy",    "friction_stroke",
      "spring_stroke", "part_peak_phase",    "part_harmonic",       "friction_force_peak"};
  const Answer found = answer(network, conveyor_values(), names);
  INFO(found.summary.reason);
  REQUIRE(found.summary.status == Status::ok);
  CHECK(std::abs(found.values[0]) > 1e-3);
  CHECK_THAT(found.values[6], WithinRel(found.values[0], 1e-12));
  std::vector<Quantity> quantities;
  for (const std::string& name : names) quantities.push_back(*find_quantity(name, network));
  const std::vector<NamedParameter> named = all_parameters(network, conveyor_values());
  std::vector<CheckedParameter> parameters;
  for (const NamedParameter& each : named) parameters.push_back(each.parameter);
  const GradientCheck check = check_gradient(network, quantities, conveyor_values(), parameters);
  REQUIRE(check.reason == "");
  for (std::size_t d = 0; d < named.size(); ++d) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const DerivativeCheck& by = check.columns[d][i];
      INFO(names[i] << " by " << named[d].name << ": " << by.exact << ", difference " << by.difference
                    << " +- " << by.uncertainty << " " << by.why_none);
      CHECK(by.why_none == "");
      const double size =
          std::max(std::abs(by.exact), 1e-3 * std::abs(found.values[i] / named[d].parameter.value));
      CHECK(std::abs(by.exact - by.difference) <= std::max(1e-6 * size, 10.0 * by.uncertainty));
    }
  }
}

// Where nothing drifts, a spring k changes the answer by a part of k.
TEST_CASE("A weak spring that holds a free mass errs in proportion to its stiffness") {
  Network held = block_on_plane();
  held.elements.push_back(on_the_mass("spring", ElementType::spring));
  const auto amplitude = [&](double k) {
    return answer(held, {.omega = 3.0, .mass = {2.0}, .element = {0.6, k}, .excitation = {{0.1, 0.0}}},
                  {"block_amplitude"})
        .values[0];
  };
  const double free =
      answer(block_on_plane(), {.omega = 3.0, .mass = {2.0}, .element = {0.6}, .excitation = {{0.1, 0.0}}},
             {"block_amplitude"})
          .values[0];
  CHECK_THAT(amplitude(0.0), WithinRel(free, 1e-14));
  const double one = amplitude(1e-3) - free, tenth = amplitude(1e-4) - free;
  CHECK(std::abs(one) < 1e-3 * free);
  CHECK_THAT(one / tenth, WithinRel(10.0, 1e-3));
}

// From the state that the history tells, the independent integration comes back after a period, but for the
// drift.
TEST_CASE("Random networks with free masses repeat as the independent integration says", "[slow]") {
  constexpr double kIntegrated = 1e-8;  // relative to the largest displacement and velocity
  std::mt19937 random(20261130);
  int compared = 0, carried = 0, unbounded = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const int masses = 1 + trial % 4, free = masses > 1 && trial % 3 == 0 ? 2 : 1;
    RandomNetwork drawn = without_some_springs({.masses = masses,
                                                .contacts = trial / 4 % 4,
                                                .maxwell_elements = trial % 5 == 3 ? 1 : 0,
                                                .orders = trial % 2 == 0 ? std::vector{1} : std::vector{1, 2},
                                                .shaken = false,
                                                .largest_friction = 0.5},
                                               free, trial / 2 % 2 == 0, random);
    drawn.network.excitations.push_back({ExcitationKind::force, 0, 0});
    drawn.values.excitation.push_back({trial % 7 == 0 ? 0.1 : 0.0, 0.0});
    const Network& network = drawn.network;
    const auto n = static_cast<Eigen::Index>(masses);
    std::vector<Quantity> quantities;
    for (std::size_t i = 0; i < network.masses.size(); ++i) quantities.push_back({Measure::drift, i});
    quantities.push_back(*find_quantity("energy_balance", network));
    PeriodicResponse response(network, quantities);
    response.set_values(drawn.values);
    const ResponseSummary& summary = response.solve();
    INFO("trial " << trial << " " << summary.reason);
    if (summary.status == Status::unbounded) {
      ++unbounded;
      continue;
    }
    CHECK(has_response(summary.status));
    if (!has_response(summary.status)) continue;
    std::vector<double> values(quantities.size());
    response.quantities(values);
    CHECK(values.back() < 1e-9);
    const History history = response.history(std::vector<double>{0.0});
    Eigen::VectorXd q(n), v(n), s(0);
    for (Eigen::Index i = 0; i < n; ++i) {
      q[i] = history.columns[static_cast<std::size_t>(2 * i)][0];
      v[i] = history.columns[static_cast<std::size_t>(2 * i) + 1][0];
    }
    std::size_t column = 2 * network.masses.size();
    for (const Element& element : network.elements) {
      if (element.type == ElementType::maxwell) {
        s.conservativeResize(s.size() + 1);
        s.tail(1)[0] = history.columns[column][0];
      }
      ++column;
    }
    ExponentialIntegrator reference(network, drawn.values);
    reference.watches_extremes = false;
    reference.start(q, v, s);
    const Eigen::VectorXd before = reference.state();
    reference.pass_period();
    Eigen::VectorXd off = reference.state() - before;
    const double size = std::max(1.0, before.cwiseAbs().maxCoeff());
    for (Eigen::Index i = 0; i < n; ++i) off[i] -= values[static_cast<std::size_t>(i)];
    CHECK(off.cwiseAbs().maxCoeff() < kIntegrated * size);
    ++compared;
    carried += std::abs(values[0]) > 1e-6 ? 1 : 0;
  }
  CHECK(compared > 200);
  CHECK(carried > 10);
  CHECK(unbounded > 3);
}

}  // namespace
}  // namespace frahm::periodic::free_orbits_test
