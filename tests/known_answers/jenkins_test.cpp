#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

#include "solvers/mechanics/modes.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "tests/known_answers/event_integrator.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// A spring and a slider in series (Jenkins) next to a spring: x'' + 2 zeta x' + x + s = cos(r tau).
namespace frahm::periodic::jenkins_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;
constexpr double kPrinted = 1e-8;   // the reference figures have nine digits
constexpr double kExact = 1e-10;    // relative, of closed forms
constexpr double kBalance = 1e-10;  // of the energy
constexpr double kGradient = 1e-6;  // of differences, extrapolated

const Node ground{}, mass{NodeKind::mass, 0};

Network braced_mass() {
  return {.masses = {"x"},
          .elements = {{"spring", ElementType::spring, ground, mass},
                       {"damper", ElementType::damper, ground, mass},
                       {"brace", ElementType::jenkins, ground, mass}},
          .excitations = {{ExcitationKind::force, 0, 1}}};
}

NetworkValues braced_values(double r, double zeta, double k_t, double F) {
  return {.omega = r,
          .mass = {1.0},
          .element = {1.0, 2.0 * zeta, k_t},
          .excitation = {{1.0, 0.0}},
          .second = {0.0, 0.0, F}};
}

// Figures by two independent methods: an event-driven integration and a half-period map of the two states.
TEST_CASE("A braced mass has the peaks of two independent methods") {
  struct Figure {
    double zeta, k_t, F, r, peak;
  };
  Responses responses(braced_mass());
  for (const auto& [zeta, k_t, F, r, peak] :
       {Figure{0.05, 1.0, 0.5, 1.1, 3.38660810}, Figure{0.02, 4.0, 0.3, 0.9, 4.17210554},
        Figure{0.05, 1.0, 0.5, 1.35, 1.48851470}}) {
    responses.solve(braced_values(r, zeta, k_t, F));
    INFO("zeta " << zeta << " k_t " << k_t << " F " << F << " r " << r);
    CHECK(responses["status"] == 1.0);
    CHECK_THAT(responses["x_peak"], WithinAbs(peak, kPrinted));
    CHECK_THAT(responses["brace_force_peak"], WithinRel(F, kExact));
    // A cycle of amplitude X takes 4 F (X - F/k_t).
    CHECK_THAT(responses["brace_energy"], WithinRel(4.0 * F * (responses["x_peak"] - F / k_t), kExact));
    CHECK(responses["energy_balance"] < kBalance);
    CHECK(responses["brace_stops"] == 2.0);
    CHECK(responses["error_bound"] < 1e-10);
  }
}

TEST_CASE("A brace that never slips is a spring, under forces of odd and of even orders") {
  for (const int order : {1, 2}) {
    Network network = braced_mass();
    network.excitations.push_back({ExcitationKind::force, 0, 3});
    network.excitations[0].order = order;
    network.reference_order = order;
    Responses responses(network);
    for (const double k_t : {0.1, 1.0, 30.0}) {
      for (const double r : {0.3, 0.9, 1.7}) {
        NetworkValues values = braced_values(r, 0.05, k_t, 1e4);
        values.excitation.push_back({0.0, 0.0});
        responses.solve(values);
        const double n = order * r, k = 1.0 + k_t;
        const double X = 1.0 / std::hypot(k - n * n, 0.1 * n);
        INFO("order " << order << " k_t " << k_t << " r " << r);
        CHECK(responses["status"] == 1.0);
        CHECK_THAT(responses["x_peak"], WithinRel(X, kExact));
        CHECK_THAT(responses["x_mean"], WithinAbs(0.0, kExact * X));
        CHECK(responses["brace_stuck_fraction"] == 1.0);
        CHECK_THAT(responses["brace_energy"], WithinAbs(0.0, kExact));
        CHECK(responses["floquet_radius"] < 1.0);
      }
    }
  }
}

TEST_CASE("A brace without friction is not there") {
  Responses braced(braced_mass()), bare(single_mass());
  for (const double r : {0.4, 1.0, 2.5}) {
    braced.solve(braced_values(r, 0.05, 2.0, 0.0));
    bare.solve(single_mass_values(r, 0.05, 0.0));
    CHECK_THAT(braced["x_peak"], WithinRel(bare["x_peak"], kExact));
  }
}

TEST_CASE("A stiffer and stiffer brace approaches a slider alone, as 1/sqrt(k_t) at most") {
  Responses braced(braced_mass()), sliding(single_mass());
  sliding.solve(single_mass_values(0.8, 0.05, 0.3));
  const double limit = sliding["x_peak"];
  double last = 1.0;
  for (const double k_t : {1e2, 1e4, 1e6}) {
    braced.solve(braced_values(0.8, 0.05, k_t, 0.3));
    const double off = std::abs(braced["x_peak"] - limit);
    INFO("k_t " << k_t);
    CHECK(braced["status"] == 1.0);
    CHECK(off < 0.5 / std::sqrt(k_t));
    CHECK(off < last);
    last = off;
  }
}

// The brace rings at sqrt(k_t) where the slider turns, by an amplitude that falls as 1/sqrt(k_t).
TEST_CASE("Where nothing sticks for long, it comes no closer than 1/sqrt(k_t)") {
  for (const double r : {0.8, 1.1}) {
    Responses braced(braced_mass()), sliding(single_mass());
    sliding.solve(single_mass_values(r, 0.05, 0.3));
    const auto off = [&](double k_t) {
      braced.solve(braced_values(r, 0.05, k_t, 0.3));
      return std::sqrt(k_t) * std::abs(braced["x_peak"] - sliding["x_peak"]);
    };
    INFO("r " << r);
    CHECK_THAT(off(1e6) / off(1e4), WithinAbs(1.0, 3e-3));
    CHECK_THAT(off(1e8) / off(1e6), WithinAbs(1.0, 3e-4));
  }
}

TEST_CASE("A constant load leaves a brace that never slips without a part of it where the energy is least") {
  Network network = braced_mass();
  network.excitations.push_back({ExcitationKind::force, 0, 0});
  NetworkValues values = braced_values(0.7, 0.05, 2.0, 10.0);
  values.excitation.push_back({0.6, 0.0});
  Responses responses(network);
  responses.solve(values);
  // Least (1/2) x^2 + s^2 / (2 k_t) with x + s = 0.6:  x = 0.6 / 3, s = 0.4.
  CHECK(responses["status"] == 1.0);
  CHECK_THAT(responses["x_mean"], WithinAbs(0.2, kExact));
  values.second[2] = 0.5;  // the swing of the force alone is 0.57: it slips
  responses.solve(values);
  CHECK(responses["brace_regime"] != static_cast<double>(Regime::stuck));
  CHECK(responses["energy_balance"] < kBalance);
}

TEST_CASE("Derivatives of a braced response agree with differences") {
  const Network network = braced_mass();
  const std::vector<Quantity> quantities = {{Measure::peak, 0},
                                            {Measure::rms, 0},
                                            {Measure::phase, 0},
                                            {Measure::energy, 2},
                                            {Measure::stroke, 2},
                                            {Measure::stuck_fraction, 2},
                                            {Measure::transmitted_force, 0}};
  for (const double r : {0.6, 1.1, 1.35, 3.0})  // at the last the slider sticks: its force moves
    check_derivatives(network, quantities, braced_values(r, 0.05, 1.0, 0.5), kGradient);
}

TEST_CASE("A spring and a slider that rests beside it keep what locks them in") {
  Network network = braced_mass();
  network.excitations.clear();
  NetworkValues values = braced_values(1.0, 0.025, 0.7, 0.2);
  values.excitation.clear();
  const transient::FreeDecay damped =
      transient::free_decay(network, values, {{3.0}, {}}, {.duration = 0.0, .samples = 2001});
  CHECK(damped.end == transient::DecayEnd::decayed);
  CHECK_THAT(damped.masses[0].rest, WithinAbs(damped.history.displacement[0].back(), 1e-5));
  CHECK(std::abs(damped.masses[0].rest) > 1e-3);  // x = -s, by less than F
  CHECK(std::abs(damped.masses[0].rest) < 0.2);

  network.elements[1].type = ElementType::coulomb;
  values.element[1] = 0.05;
  const transient::FreeDecay held = transient::free_decay(network, values, {{3.0}, {}}, {.duration = 0.0});
  CHECK(held.end == transient::DecayEnd::at_rest);
  CHECK(held.stop_time > 0.0);
}

TEST_CASE("Without damping a slider behind a spring holds a resonance up to 4 F / pi") {
  Responses responses(braced_mass());
  NetworkValues values = braced_values(1.0, 0.0, 0.5, 0.3);
  for (const double load : {0.97, 1.03}) {
    values.excitation[0].amplitude = load * 4.0 * 0.3 / std::numbers::pi;
    responses.solve(values);
    CHECK(responses["status"] == (load < 1.0 ? 1.0 : 3.0));
  }
}

TEST_CASE("A slider at its limit beside a contact that holds it slides on with it, and nothing grazes") {
  Network network = braced_mass();
  network.elements.push_back({"guide", ElementType::coulomb, ground, mass});
  network.excitations.push_back({ExcitationKind::force, 0, 3});
  Responses responses(network);
  for (int i = 0; i < 50; ++i) {
    NetworkValues values = braced_values(0.165 + 2e-4 * i, 0.05, 1.0, 0.1);
    values.element.push_back(0.5);
    values.second.push_back(0.0);
    values.excitation.push_back({0.7, 1.0});
    responses.solve(values);
    INFO("r " << values.omega);
    CHECK(responses["status"] == 1.0);
    CHECK(responses["energy_balance"] < kBalance);
  }
}

TEST_CASE("A slider shaken down under a constant load is no grazing contact") {
  Network network = braced_mass();
  network.excitations.push_back({ExcitationKind::force, 0, 0});
  Responses responses(network);
  for (const double F : {0.4, 0.5, 0.7}) {
    NetworkValues values = braced_values(1.0, 0.3, 0.5, F);
    values.element[0] = 2.0;
    values.excitation.push_back({0.3, 0.0});
    responses.solve(values);
    CHECK(responses["status"] == 1.0);
    CHECK(responses["error_bound"] < kExact);
    CHECK(responses["brace_force_peak"] < 0.37);  // the slider never moves
  }
}

TEST_CASE("With all friction stuck the spring behind a slider pulls") {
  const LinearModes modes = linear_modes(braced_mass(), braced_values(1.0, 0.0, 3.0, 0.1), true);
  REQUIRE(modes.frequency.size() == 1);
  CHECK_THAT(modes.frequency[0], WithinRel(2.0, kExact));
}

TEST_CASE("A brace in a decay and in a forced motion shares out all energy") {
  const auto check = [](const transient::EnergyBudget& energy) {
    CHECK(energy.balance < 1e-12);
    CHECK(energy.dissipated[2] > 0.0);
  };
  const transient::FreeDecay decay = transient::free_decay(braced_mass(), braced_values(1.0, 0.01, 3.0, 0.4),
                                                           {{2.0}, {}}, {.duration = 40.0, .samples = 9});
  check(decay.energy);
  const NetworkValues values = braced_values(1.1, 0.05, 1.0, 0.5);
  const transient::ForcedMotion forced =
      transient::forced_motion(braced_mass(), [&](double) { return values; }, {{0.0}, {}},
                               {.from = 1.1, .duration = 400.0, .samples = 3});
  check(forced.energy);
  CHECK_THAT(std::abs(forced.peaks[0].displacement), WithinAbs(3.3866, 0.6));  // it overshoots on its way
}

// Three storeys on a shaken ground, braces in the first and the last.
TEST_CASE("A building whose braces slip moves from rest as the independent integration says") {
  constexpr double kAlike = 1e-9;  // of the ground's amplitude
  const Node base{NodeKind::prescribed, 0}, floors[] = {mass, {NodeKind::mass, 1}, {NodeKind::mass, 2}};
  Network network{.masses = {"floor1", "floor2", "floor3"},
                  .prescribed = {"base"},
                  .elements = {},
                  .excitations = {{ExcitationKind::motion, 0, 1}}};
  NetworkValues values;
  values.excitation = {{1.0, -0.5 * std::numbers::pi}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Node below = i == 0 ? base : floors[i - 1];
    network.elements.push_back({"columns", ElementType::spring, below, floors[i]});
    network.elements.push_back({"damping", ElementType::damper, below, floors[i]});
    values.mass.push_back(1.0);
    values.element.insert(values.element.end(), {1.0, 0.02});
    values.second.insert(values.second.end(), {0.0, 0.0});
    if (i == 1) continue;
    network.elements.push_back({"brace", ElementType::jenkins, below, floors[i]});
    values.element.push_back(1.5);
    values.second.push_back(0.4);
  }
  for (const double r : {0.3, 0.55, 1.4}) {
    INFO("r " << r);
    values.omega = r;
    const double duration = 30.0 / r;
    const transient::ForcedMotion motion = transient::forced_motion(
        network, [&](double) { return values; }, {}, {.from = r, .duration = duration, .samples = 2});
    REQUIRE(motion.failure.empty());
    const Assembly assembly(network);
    LinearSystem system;
    assembly.set_values(values, system);
    assembly.set_forcing(values, system);
    EventIntegrator reference(system);
    reference.start(0.0, Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(2));
    reference.advance_to(duration);
    CHECK(reference.events() > 10);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK_THAT(motion.history.displacement[i].back(),
                 WithinAbs(reference.displacements()[static_cast<Eigen::Index>(i)], kAlike));
    CHECK(motion.energy.balance < kBalance);
  }
}

}  // namespace
}  // namespace frahm::periodic::jenkins_test
