#include "solvers/transient/free_decay.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/known_answers/event_integrator.hpp"
#include "tests/known_answers/free_oscillator.hpp"

// Free vibration against the closed forms of one mass and an independent integration.
namespace frahm::transient::free_decay_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
constexpr double kExact = 1e-12;  // relative to the first displacement, and of times

FreeDecay decay_of(const FreeOscillator& oscillator, double x_0, const DecayOptions& options = {}) {
  return free_decay(oscillator.network(), oscillator.values(), {{x_0}, {}}, options);
}

// All turning points, their times, stop time and rest, from the recursion.
void check_recursion(const FreeOscillator& oscillator, double x_0) {
  const FreeDecay decay = decay_of(oscillator, x_0);
  const auto expected = oscillator.turning_points(x_0, 100000);
  INFO("zeta " << oscillator.zeta << " x_f " << oscillator.x_f << " x_0 " << x_0);
  CHECK(decay.end == DecayEnd::at_rest);
  const auto& extrema = decay.masses[0].extrema;
  REQUIRE(extrema.size() == expected.size());
  double error = 0.0, time_error = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    error = std::max(error, std::abs(extrema[i].displacement - expected[i]));
    const double time = static_cast<double>(i) * oscillator.half_period();
    time_error = std::max(time_error, std::abs(extrema[i].time - time) / std::max(time, 1e-300));
  }
  CHECK(error < kExact * std::abs(x_0));
  CHECK(time_error < kExact);
  const double stop = static_cast<double>(expected.size() - 1) * oscillator.half_period();
  CHECK_THAT(decay.stop_time, WithinRel(stop, kExact));
  CHECK_THAT(decay.masses[0].rest, WithinAbs(expected.back(), kExact * std::abs(x_0)));
  CHECK(decay.duration == decay.stop_time);
}

TEST_CASE(
    "Coulomb friction and viscous damping: every turning point, the stop and the rest are the recursion's") {
  for (const double zeta : {0.0, 0.01, 0.05, 0.3, 0.7}) {
    for (const double x_0 : {1.0, -0.83}) {
      check_recursion({.m = 2.0, .k = 50.0, .zeta = zeta, .x_f = 0.0173}, x_0);
    }
  }
}

TEST_CASE("A hundred cycles of dry friction lose 4 F/k each, at the frequency of the undamped system") {
  const FreeOscillator oscillator{.m = 3.0, .k = 700.0, .x_f = 0.0011};
  check_recursion(oscillator, 0.4837);
  const FreeDecay decay = decay_of(oscillator, 0.4837);
  const auto& extrema = decay.masses[0].extrema;
  REQUIRE(extrema.size() > 200);
  for (std::size_t i = 0; i + 3 < extrema.size(); ++i) {  // the last one need not cross the middle
    CHECK_THAT(std::abs(extrema[i].displacement) - std::abs(extrema[i + 2].displacement),
               WithinAbs(4.0 * oscillator.x_f, kExact * 0.4837));
  }
}

TEST_CASE("A turning point exactly at the edge of the sticking zone is the last one") {
  const FreeOscillator oscillator{.m = 1.0, .k = 4.0, .x_f = 0.125};
  const FreeDecay decay = decay_of(oscillator, 0.625);  // 5 x_f, 3 x_f, x_f: every step exact in binary
  REQUIRE(decay.masses[0].extrema.size() == 3);
  CHECK_THAT(decay.masses[0].rest, WithinAbs(0.125, kExact));
  CHECK_THAT(decay.stop_time, WithinRel(std::numbers::pi, kExact));
}

TEST_CASE("A release within the sticking zone never moves") {
  const FreeDecay decay = decay_of({.x_f = 0.2}, 0.15, {.samples = 3});
  CHECK(decay.end == DecayEnd::at_rest);
  CHECK(decay.stop_time == 0.0);
  CHECK(decay.masses[0].rest == 0.15);
  REQUIRE(decay.masses[0].extrema.size() == 1);
  CHECK(decay.history.displacement[0] == std::vector<double>{0.15, 0.15, 0.15});
}

TEST_CASE("Viscous damping below critical: the logarithmic decrement is 2 pi zeta / s in every cycle") {
  for (const double zeta : {0.002, 0.05, 0.3}) {
    const FreeOscillator oscillator{.m = 0.5, .k = 80.0, .zeta = zeta};
    const FreeDecay decay = decay_of(oscillator, 0.02);
    INFO("zeta " << zeta);
    CHECK(std::isnan(decay.stop_time));
    CHECK(decay.masses[0].rest == 0.0);
    const auto& decrement = decay.masses[0].log_decrement;
    REQUIRE(decrement.size() > 4);
    // A displacement of 1e-6 of the first is exact to 1e-12 of the first, so to 1e-6 of itself at the end;
    // the first ones are looked at closely.
    constexpr double kFirst = 1e-11;
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK_THAT(decrement[i], WithinAbs(2.0 * std::numbers::pi * zeta / oscillator.s(), kFirst));
    }
    CHECK(std::isnan(decrement.back()));
  }
}

TEST_CASE("Without any damping the turning points keep their size and the motion has no end of its own") {
  const FreeOscillator oscillator{.m = 1.0, .k = 9.0};
  const FreeDecay decay = decay_of(oscillator, 0.3);
  CHECK(decay.end == DecayEnd::cut_off);
  CHECK_THAT(decay.duration, WithinRel(kMostPeriods * 2.0 * oscillator.half_period(), 1e-9));
  CHECK(std::isnan(decay.masses[0].rest));
  constexpr double kThousandPeriods = 1e-10;  // roundings of some ten thousand steps
  double error = 0.0;
  for (const Extremum& extremum : decay.masses[0].extrema) {
    error = std::max(error, std::abs(std::abs(extremum.displacement) - 0.3));
  }
  CHECK(error < kThousandPeriods);
  CHECK(decay.masses[0].extrema.size() >= 2000);
}

// x(t) of a release at x_0 without friction, zeta >= 1.
double overdamped(const FreeOscillator& o, double x_0, double t) {
  const double w = o.natural_frequency();
  if (o.zeta == 1.0) return x_0 * (1.0 + w * t) * std::exp(-w * t);
  const double root = std::sqrt(o.zeta * o.zeta - 1.0);
  const double a = w * (-o.zeta + root), b = w * (-o.zeta - root);
  return x_0 * (a * std::exp(b * t) - b * std::exp(a * t)) / (a - b);
}

TEST_CASE("Critical and higher damping return without overshoot, critical fastest") {
  double critical = 0.0;
  for (const double zeta : {1.0, 1.5, 6.0}) {
    const FreeOscillator oscillator{.m = 2.0, .k = 32.0, .zeta = zeta};
    const FreeDecay decay = decay_of(oscillator, 0.7, {.samples = 101});
    INFO("zeta " << zeta);
    CHECK(decay.end == DecayEnd::decayed);
    CHECK(std::isnan(decay.stop_time));
    CHECK(decay.masses[0].rest == 0.0);
    CHECK(decay.masses[0].extrema.size() == 1);
    for (std::size_t i = 0; i < 101; ++i) {
      const double expected = overdamped(oscillator, 0.7, decay.history.time[i]);
      CHECK_THAT(decay.history.displacement[0][i], WithinAbs(expected, kExact));
      CHECK(decay.history.displacement[0][i] > 0.0);
    }
    if (zeta == 1.0) critical = decay.duration;
    CHECK(decay.duration >= critical);
  }
}

TEST_CASE("With friction and critical or higher damping the mass creeps to x_f and never arrives") {
  for (const double zeta : {1.0, 1.5, 4.0}) {
    const FreeOscillator oscillator{.m = 2.0, .k = 32.0, .zeta = zeta, .x_f = 0.04};
    const FreeDecay decay = decay_of(oscillator, -0.7, {.samples = 51});
    INFO("zeta " << zeta);
    CHECK(decay.end == DecayEnd::creeping);
    CHECK(std::isnan(decay.stop_time));
    CHECK_THAT(decay.masses[0].rest, WithinAbs(-0.04, kExact));
    CHECK(decay.masses[0].extrema.size() == 1);
    for (std::size_t i = 0; i < 51; ++i) {
      const double expected = -0.04 + overdamped(oscillator, -0.66, decay.history.time[i]);
      CHECK_THAT(decay.history.displacement[0][i], WithinAbs(expected, 1e-10));
    }
  }
}

TEST_CASE(
    "Thrown through the sticking zone with friction and high damping it turns once, stops and creeps back") {
  // From x_0 < 0 with a velocity that carries it beyond x_f: there the spring pulls it back to x_f.
  const FreeOscillator oscillator{.m = 1.0, .k = 1.0, .zeta = 1.2, .x_f = 0.05};
  const FreeDecay decay = free_decay(oscillator.network(), oscillator.values(), {{-0.5}, {8.0}}, {});
  CHECK(decay.end == DecayEnd::creeping);
  REQUIRE(decay.masses[0].extrema.size() == 1);
  CHECK(decay.masses[0].extrema[0].displacement > 0.05);
  CHECK_THAT(decay.masses[0].rest, WithinAbs(0.05, kExact));
}

TEST_CASE("A decay cut short keeps what happens until then, and still knows where it will rest") {
  const FreeOscillator oscillator{.zeta = 0.02, .x_f = 0.01};
  const FreeDecay whole = decay_of(oscillator, 1.0);
  const FreeDecay cut =
      decay_of(oscillator, 1.0, {.duration = 5.5 * oscillator.half_period(), .samples = 12});
  CHECK(cut.masses[0].extrema.size() == 6);
  CHECK(std::isnan(cut.stop_time));
  // The given duration ends a passage of its own, which leaves a rounding.
  CHECK_THAT(cut.masses[0].rest, WithinAbs(whole.masses[0].rest, kExact));
  CHECK(cut.history.time.back() == cut.duration);
}

TEST_CASE("A hysteretic spring decays as the viscous damper that equals it at the natural frequency") {
  using namespace mechanics;
  const double m = 2.0, k = 200.0, eta = 0.08;
  const Network network{.masses = {"x"},
                        .elements = {{"mount", ElementType::hysteretic, Node{}, Node{NodeKind::mass, 0}}}};
  NetworkValues values{.mass = {m}, .element = {k}, .second = {eta}};
  const FreeDecay decay = free_decay(network, values, {{0.1}, {}}, {});
  CHECK_THAT(decay.hysteretic_omega, WithinRel(10.0, kExact));
  // c = eta k / omega_n = 2 zeta m omega_n: zeta = eta / 2
  const FreeOscillator viscous{.m = m, .k = k, .zeta = eta / 2.0};
  CHECK_THAT(decay.masses[0].log_decrement[0],
             WithinAbs(2.0 * std::numbers::pi * viscous.zeta / viscous.s(), 1e-11));
  values.hysteretic_omega = 20.0;
  const FreeOscillator weaker{.m = m, .k = k, .zeta = eta / 4.0};
  CHECK_THAT(free_decay(network, values, {{0.1}, {}}, {}).masses[0].log_decrement[0],
             WithinAbs(2.0 * std::numbers::pi * weaker.zeta / weaker.s(), 1e-11));
}

// The rig let go: main mass and absorber, friction in both guides.
mechanics::Network free_rig() {
  using namespace mechanics;
  const Node ground{}, main{NodeKind::mass, 0}, tmd{NodeKind::mass, 1};
  return {.masses = {"main", "tmd"},
          .elements = {{"suspension", ElementType::spring, ground, main},
                       {"guide_damper", ElementType::damper, ground, main},
                       {"guide", ElementType::coulomb, ground, main},
                       {"tmd_spring", ElementType::spring, tmd, main},
                       {"tmd_damper", ElementType::damper, tmd, main},
                       {"inerter", ElementType::inerter, tmd, main},
                       {"tmd_friction", ElementType::coulomb, tmd, main}}};
}
mechanics::NetworkValues free_rig_values(double D, double d) {
  return {.mass = {102.66, 12.82}, .element = {7.0 * 8181.0, 1.7688, D, 10985.1, 29.57, 6.36, d}};
}

TEST_CASE("Two masses with two frictions move as the independent integration says, until they rest") {
  const mechanics::Assembly assembly(free_rig());
  for (const auto& [D, d] : {std::pair{10.127, 15.0109}, {60.0, 5.0}, {3.0, 40.0}}) {
    mechanics::NetworkValues values = free_rig_values(D, d);
    const double duration = 4.0;
    const FreeDecay decay =
        free_decay(free_rig(), values, {{0.03, -0.01}, {0.1, 0.0}}, {.duration = duration, .samples = 41});
    mechanics::LinearSystem system;
    values.omega = 20.0;
    assembly.set_values(values, system);
    assembly.set_forcing(values, system);
    periodic::EventIntegrator reference(system);
    reference.start(0.0, Eigen::Vector2d(0.03, -0.01), Eigen::Vector2d(0.1, 0.0));
    constexpr double kIntegrated =
        1e-10;  // [m] of 0.03: the integrator's own tolerance over dozens of events
    double error = 0.0;
    for (std::size_t i = 1; i < 41; ++i) {
      reference.advance_to(decay.history.time[i]);
      const Eigen::VectorXd q = reference.displacements();
      for (const std::size_t mass : {0U, 1U}) {
        error = std::max(error,
                         std::abs(decay.history.displacement[mass][i] - q[static_cast<Eigen::Index>(mass)]));
      }
    }
    INFO("D " << D << " d " << d << " events " << reference.events() << " error " << error);
    CHECK(reference.events() > 10);
    CHECK(error < kIntegrated);
    CHECK(decay.end == DecayEnd::at_rest);
    if (decay.stop_time < duration) {
      CHECK_THAT(decay.masses[0].rest, WithinAbs(reference.displacements()[0], kIntegrated));
      CHECK_THAT(decay.masses[1].rest, WithinAbs(reference.displacements()[1], kIntegrated));
    }
  }
}

TEST_CASE("Where they rest, friction holds the springs") {
  const FreeDecay decay = free_decay(free_rig(), free_rig_values(10.127, 15.0109), {{0.03, 0.03}, {}}, {});
  REQUIRE(decay.end == DecayEnd::at_rest);
  const double x = decay.masses[0].rest, y = decay.masses[1].rest;
  const double tmd_force = 10985.1 * (x - y);
  CHECK(std::abs(tmd_force) <= 15.0109 * (1.0 + kExact));
  CHECK(std::abs(7.0 * 8181.0 * x) <= 10.127 * (1.0 + kExact));
}

TEST_CASE("Two masses without damping keep their energy") {
  mechanics::NetworkValues values = free_rig_values(0.0, 0.0);
  values.element[1] = values.element[4] = 0.0;
  const FreeDecay decay =
      free_decay(free_rig(), values, {{0.03, -0.01}, {0.1, 0.0}}, {.duration = 20.0, .samples = 201});
  const auto energy = [&](std::size_t i) {
    const double x = decay.history.displacement[0][i], y = decay.history.displacement[1][i];
    const double v = decay.history.velocity[0][i], w = decay.history.velocity[1][i];
    return 0.5 * (102.66 * v * v + 12.82 * w * w + 6.36 * (v - w) * (v - w) + 7.0 * 8181.0 * x * x +
                  10985.1 * (x - y) * (x - y));
  };
  constexpr double kKept = 1e-11;  // roundings of some thousand steps
  for (std::size_t i = 1; i < 201; ++i) CHECK_THAT(energy(i), WithinRel(energy(0), kKept));
  CHECK(decay.end == DecayEnd::cut_off);
}

TEST_CASE("Initial values that are no numbers, or of the wrong number, are refused") {
  const FreeOscillator oscillator{.zeta = 0.1};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(decay_of(oscillator, nan), mechanics::MechanicsError);
  CHECK_THROWS_AS(free_decay(oscillator.network(), oscillator.values(), {{1.0, 2.0}, {}}, {}),
                  mechanics::MechanicsError);
}

}  // namespace
}  // namespace frahm::transient::free_decay_test
