#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "solvers/identification/added_mass.hpp"
#include "solvers/identification/energy_balance.hpp"
#include "solvers/identification/hysteresis_loop.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"
#include "tests/solvers/coverage.hpp"

// Energy balance, hysteresis loops and added masses, on responses that the engine makes.
namespace frahm::identification::energy_loss_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel, Catch::Matchers::Contains;
using std::numbers::pi;
constexpr double kExact = 1e-10;

struct Balance {
  EnergyRows rows;
  double velocity_share;  // of the harmonics above the first in the mean square of the velocity, at most
};

// Between its reversals the velocity is smooth: Simpson's rule over half a cycle, from the largest
// displacement on. Its error is (pi / 1000)^4 / 180 of the fourth derivative, some 1e-12.
double mean_square_velocity(periodic::Responses& responses) {
  constexpr int kIntervals = 1000;
  std::vector<double> phases;
  for (int i = 0; i <= kIntervals; ++i) phases.push_back(responses["x_peak_phase"] + pi * i / kIntervals);
  const auto history = responses.response().history(phases);
  const auto column =
      std::find(history.names.begin(), history.names.end(), "x_velocity") - history.names.begin();
  const auto& v = history.columns[static_cast<std::size_t>(column)];
  double sum = 0.0;
  for (std::size_t i = 0; i <= kIntervals; ++i)
    sum += v[i] * v[i] * (i == 0 || i == kIntervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0));
  return sum / (3.0 * kIntervals);
}

// A mass of 2 kg on 800 N/m (omega_n = 20 rad/s), c = 3 N s/m, F = 1.5 N, shaken by forces at omega.
constexpr double kDamping = 3.0, kFriction = 1.5;
Balance balance_of(double omega, int count) {
  periodic::Responses responses(periodic::single_mass());
  Balance balance{{}, 0.0};
  for (int i = 0; i < count; ++i) {
    responses.solve({.omega = omega,
                     .mass = {2.0},
                     .element = {800.0, kDamping, kFriction},
                     .excitation = {{3.0 + 2.0 * i, 0.0}}});
    REQUIRE(responses["friction_stops"] == 0.0);
    REQUIRE(responses["friction_reversals"] == 2.0);
    const double mean_square = mean_square_velocity(responses);
    const double first = omega * responses["x_harmonic"];
    balance.velocity_share = std::max(balance.velocity_share, 1.0 - 0.5 * first * first / mean_square);
    balance.rows.amplitude.push_back(responses["x_amplitude"]);
    balance.rows.energy.push_back(responses["energy_input"]);
    balance.rows.velocity_rms.push_back(std::sqrt(mean_square));
  }
  balance.rows.omega = {omega};
  return balance;
}

TEST_CASE("With the measured velocity the energy balance is exact whatever the waveform") {
  for (const double omega : {13.0, 20.0, 31.0}) {
    const Balance balance = balance_of(omega, 7);
    const Identification result = energy_balance(balance.rows);
    INFO("omega " << omega << " harmonics " << balance.velocity_share);
    REQUIRE(result.failure == "");
    CHECK_THAT(value_of(result, "damping"), WithinRel(kDamping, kExact));
    CHECK_THAT(value_of(result, "friction_force"), WithinRel(kFriction, kExact));
  }
}

TEST_CASE("Rows that obey the balance give its damping and friction exactly, frequencies in common or not") {
  EnergyRows rows{
      .amplitude = {0.01, 0.02, 0.05}, .energy = {}, .omega = {20.0, 25.0, 30.0}, .velocity_rms = {}};
  for (std::size_t i = 0; i < 3; ++i)
    rows.energy.push_back(pi * kDamping * rows.omega[i] * rows.amplitude[i] * rows.amplitude[i] +
                          4.0 * kFriction * rows.amplitude[i]);
  Identification result = energy_balance(rows);
  CHECK_THAT(value_of(result, "damping"), WithinRel(kDamping, kExact));
  CHECK_THAT(value_of(result, "friction_force"), WithinRel(kFriction, kExact));
  // The rms velocity of a harmonic motion says the same.
  for (std::size_t i = 0; i < 3; ++i)
    rows.velocity_rms.push_back(rows.omega[i] * rows.amplitude[i] / std::numbers::sqrt2);
  result = energy_balance(rows);
  CHECK_THAT(value_of(result, "damping"), WithinRel(kDamping, kExact));
  // As many rows as unknowns.
  rows = {.amplitude = {0.01, 0.02}, .energy = {0.07, 0.2}, .omega = {20.0}, .velocity_rms = {}};
  CHECK(std::isnan(estimate_of(energy_balance(rows), "damping").low));
}

TEST_CASE(
    "Taken for harmonic, the motion's harmonics are the error of the damping, and at resonance a small one") {
  const Balance balance = balance_of(20.0, 7);
  EnergyRows rows = balance.rows;
  rows.velocity_rms.clear();
  const Identification result = energy_balance(rows);
  // Shares of the loss go to the other of the two: what the damper is off by is off by a few such shares.
  INFO("harmonics " << balance.velocity_share);
  CHECK(balance.velocity_share < 0.02);
  CHECK_THAT(value_of(result, "damping"), WithinRel(kDamping, 3.0 * balance.velocity_share));
  CHECK_THAT(value_of(result, "friction_force"), WithinRel(kFriction, 3.0 * balance.velocity_share));
}

TEST_CASE("Of a hundred noisy energy balances the intervals hold the truth in ninety at least") {
  const Balance balance = balance_of(20.0, 10);
  std::vector<Truth> truths{{"damping", kDamping}, {"friction_force", kFriction}};
  count_held(truths, [&](unsigned seed) {
    EnergyRows rows = balance.rows;
    rows.energy = Noise(seed).on(rows.energy, 0.02);  // of 0.3 to 30 J
    return energy_balance(rows);
  });
  for (const Truth& truth : truths) {
    INFO(truth.name << " held " << truth.held);
    CHECK(truth.held >= kHeld);
  }
}

TEST_CASE("An energy balance that cannot tell the two apart says so") {
  const auto refused = [](const EnergyRows& rows) { return energy_balance(rows).failure; };
  CHECK_THAT(refused({.amplitude = {1.0, 1.0}, .energy = {1.0, 2.0}, .omega = {1.0}, .velocity_rms = {}}),
             Contains("have one amplitude"));
  CHECK_THAT(
      refused({.amplitude = {1.0, 2.0}, .energy = {1.0, 2.0}, .omega = {4.0, 2.0}, .velocity_rms = {}}),
      Contains("frequency times amplitude, 4 m/s"));
  CHECK_THAT(
      refused({.amplitude = {1.0, 4.0}, .energy = {1.0, 2.0}, .omega = {3.0}, .velocity_rms = {1.0, 2.0}}),
      Contains("rms velocity squared over frequency times amplitude"));
  CHECK_THAT(refused({.amplitude = {1.0, 2.0}, .energy = {1.0, -2.0}, .omega = {1.0}, .velocity_rms = {}}),
             Contains("energy 2 of 2 is -2"));
  CHECK_THAT(refused({.amplitude = {1.0}, .energy = {1.0}, .omega = {1.0}, .velocity_rms = {}}),
             Contains("two amplitudes"));
  CHECK_THAT(refused({.amplitude = {1.0, 0.0}, .energy = {1.0, 2.0}, .omega = {1.0}, .velocity_rms = {}}),
             Contains("amplitude 2 of 2 is 0"));
  CHECK_THAT(refused({.amplitude = {1.0, 2.0}, .energy = {1.0, 2.0}, .omega = {}, .velocity_rms = {}}),
             Contains("0 frequencies for 2 rows"));
  CHECK_THAT(refused({.amplitude = {1.0, 2.0}, .energy = {1.0, 2.0}, .omega = {1.0}, .velocity_rms = {1.0}}),
             Contains("1 rms velocities for 2 rows"));
}

// The loop of an element between a mass and ground under a force at omega, over `periods`.
struct Loop {
  LoopTraces traces;
  double amplitude, energy;
};
Loop loop_of(const std::vector<mechanics::Element>& elements, const std::vector<double>& value,
             const std::vector<double>& second, double omega, double periods, int samples_a_period) {
  mechanics::Network network = periodic::single_mass();
  network.elements = elements;
  periodic::Responses responses(network);
  responses.solve(
      {.omega = omega, .mass = {2.0}, .element = value, .excitation = {{5.0, 0.0}}, .second = second});
  const auto samples = static_cast<int>(periods * samples_a_period);
  std::vector<double> phases(static_cast<std::size_t>(samples_a_period));
  for (int i = 0; i < samples_a_period; ++i)
    phases[static_cast<std::size_t>(i)] = 2.0 * pi * i / samples_a_period;
  const auto history = responses.response().history(phases);
  Loop loop{{}, responses["x_amplitude"], responses["energy_input"]};
  for (int i = 0; i < samples; ++i) {
    const auto at = static_cast<std::size_t>(i % samples_a_period);
    loop.traces.time.push_back(2.0 * pi / omega * i / samples_a_period);
    double force = 0.0;
    for (std::size_t column = 0; column < history.names.size(); ++column) {
      const std::string& name = history.names[column];
      if (name == "x_displacement") loop.traces.displacement.push_back(history.columns[column][at]);
      if (name.ends_with("_force")) force += history.columns[column][at];
    }
    loop.traces.force.push_back(force);
  }
  return loop;
}

const mechanics::Node kMass{mechanics::NodeKind::mass, 0};
const std::vector<mechanics::Element> viscous{{"spring", mechanics::ElementType::spring, {}, kMass},
                                              {"damper", mechanics::ElementType::damper, {}, kMass}};
const std::vector<mechanics::Element> hysteretic{{"mount", mechanics::ElementType::hysteretic, {}, kMass}};
const std::vector<mechanics::Element> rubbing{{"spring", mechanics::ElementType::spring, {}, kMass},
                                              {"damper", mechanics::ElementType::damper, {}, kMass},
                                              {"friction", mechanics::ElementType::coulomb, {}, kMass}};

TEST_CASE("The loop of spring and damper gives stiffness and damping exactly, and its frequency") {
  for (const double periods : {3.7, 12.0}) {
    const double omega = 17.0, k = 800.0, c = 6.0;
    const Loop loop = loop_of(viscous, {k, c}, {}, omega, periods, 96);
    INFO("periods " << periods);
    const Identification result = hysteresis_loop(loop.traces);
    REQUIRE(result.failure == "");
    CHECK_THAT(value_of(result, "frequency"), WithinRel(omega, kExact));
    CHECK_THAT(value_of(result, "storage_stiffness"), WithinRel(k, kExact));
    CHECK_THAT(value_of(result, "equivalent_damping"), WithinRel(c, kExact));
    CHECK_THAT(value_of(result, "amplitude"), WithinRel(loop.amplitude, kExact));
    CHECK_THAT(value_of(result, "energy_loss"), WithinRel(loop.energy, kExact));
    CHECK_THAT(value_of(result, "loss_factor"), WithinRel(c * omega / k, kExact));
    CHECK_THAT(value_of(result, "equivalent_friction"),
               WithinRel(pi * c * omega * loop.amplitude / 4.0, kExact));
  }
}

TEST_CASE("The loop of a hysteretic mount gives its loss factor, at any frequency") {
  for (const double omega : {5.0, 20.0, 40.0}) {
    const Loop loop = loop_of(hysteretic, {800.0}, {0.12}, omega, 4.0, 64);
    const Identification result = hysteresis_loop(loop.traces);
    REQUIRE(result.failure == "");
    CHECK_THAT(value_of(result, "loss_factor"), WithinRel(0.12, kExact));
    CHECK_THAT(value_of(result, "storage_stiffness"), WithinRel(800.0, kExact));
  }
}

TEST_CASE("The loop of a rubbing element loses what the engine says, to the sampling of its jumps") {
  const double omega = 20.0;
  const Loop loop = loop_of(rubbing, {800.0, 3.0, 1.2}, {}, omega, 6.0, 2000);
  const Identification result = hysteresis_loop(loop.traces);
  REQUIRE(result.failure == "");
  // A force that jumps between two samples is known to 1/2000 of a period, where the velocity is nothing.
  constexpr double kSampled = 1e-3;
  CHECK_THAT(value_of(result, "energy_loss"), WithinRel(loop.energy, kSampled));
  CHECK_THAT(value_of(result, "amplitude"), WithinRel(loop.amplitude, kSampled));
  const double friction = 1.2 + pi * 3.0 * omega * loop.amplitude / 4.0;
  CHECK_THAT(value_of(result, "equivalent_friction"),
             WithinRel(friction, 0.01));  // its harmonics are left out here
}

TEST_CASE("Of a hundred noisy loops the intervals hold the truth in ninety at least") {
  const double omega = 17.0, k = 800.0, c = 6.0;
  const Loop loop = loop_of(viscous, {k, c}, {}, omega, 5.3, 80);
  std::vector<Truth> truths{{"frequency", omega},          {"storage_stiffness", k},
                            {"equivalent_damping", c},     {"energy_loss", loop.energy},
                            {"amplitude", loop.amplitude}, {"loss_factor", c * omega / k}};
  count_held(truths, [&](unsigned seed) {
    Noise noise(seed);
    LoopTraces traces = loop.traces;
    traces.displacement = noise.on(traces.displacement, 0.02 * loop.amplitude);
    traces.force = noise.on(traces.force, 0.02 * k * loop.amplitude);
    return hysteresis_loop(traces);
  });
  for (const Truth& truth : truths) {
    INFO(truth.name << " held " << truth.held);
    CHECK(truth.held >= kHeld);
  }
}

TEST_CASE("A loop that is none says why") {
  Loop loop = loop_of(viscous, {800.0, 6.0}, {}, 17.0, 1.0, 40);
  CHECK_THAT(hysteresis_loop(loop.traces).failure, Contains("at least two periods"));
  const Loop coarse = loop_of(viscous, {800.0, 6.0}, {}, 17.0, 5.0, 3);
  CHECK_THAT(hysteresis_loop(coarse.traces).failure, Contains("four samples in each"));
  std::fill(loop.traces.displacement.begin(), loop.traces.displacement.end(), 1.0);
  CHECK_THAT(hysteresis_loop(loop.traces).failure, Contains("does not change"));
  loop.traces.force[4] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THAT(hysteresis_loop(loop.traces).failure, Contains("force 5 of 40 is nan"));
  loop.traces.force.pop_back();
  CHECK_THAT(hysteresis_loop(loop.traces).failure, Contains("different lengths"));
}

// x = sin, F = k x + c v, over four cycles of 50 samples.
LoopTraces traces_of(double k, double c, double omega) {
  LoopTraces traces;
  for (int i = 0; i < 200; ++i) {
    const double t = 2.0 * pi / omega * i / 50.0;
    traces.time.push_back(t);
    traces.displacement.push_back(std::sin(omega * t));
    traces.force.push_back(k * std::sin(omega * t) + c * omega * std::cos(omega * t));
  }
  return traces;
}

TEST_CASE("Without a stiffness there is no loss factor, and a loop that runs the other way is noted") {
  const LoopTraces damper = traces_of(0.0, 6.0, 17.0);
  LoopTraces noisy = damper;
  noisy.force = Noise(1).on(noisy.force, 1.0);
  for (const LoopTraces& traces : {damper, noisy}) {
    const Identification result = hysteresis_loop(traces);
    REQUIRE(result.failure == "");
    CHECK(std::isnan(value_of(result, "loss_factor")));
    CHECK(std::isinf(estimate_of(result, "loss_factor").standard_error));
    CHECK_THAT(value_of(result, "equivalent_damping"), WithinRel(6.0, 0.01));
    REQUIRE(result.notes.size() == 1);
    CHECK_THAT(result.notes[0], Contains("the loss factor is not determined"));
  }
  const Identification turned = hysteresis_loop(traces_of(-800.0, -6.0, 17.0));
  REQUIRE(turned.notes.size() == 1);
  CHECK_THAT(turned.notes[0], Contains("runs the other way"));
  CHECK_THAT(value_of(turned, "loss_factor"), WithinRel(6.0 * 17.0 / 800.0, kExact));
  CHECK(hysteresis_loop(traces_of(800.0, 6.0, 17.0)).notes.empty());
}

TEST_CASE("Frequencies with and without an added mass give mass and stiffness exactly") {
  // The rig: 102.66 kg on 7 springs of 8181 N/m, 20 kg added; the engine's natural frequencies.
  const double M = 102.66, K = 7.0 * 8181.0;
  AddedMassRows rows;
  for (const double added : {0.0, 20.0}) {
    periodic::Responses responses(periodic::single_mass());
    responses.solve(
        {.omega = 20.0, .mass = {M + added}, .element = {K, 1.7688, 0.0}, .excitation = {{1.0, 0.0}}});
    rows.added.push_back(added);
    rows.omega.push_back(responses["natural_frequency_1"]);
  }
  Identification result = added_mass(rows);
  REQUIRE(result.failure == "");
  CHECK_THAT(value_of(result, "mass"), WithinRel(M, kExact));
  CHECK_THAT(value_of(result, "stiffness"), WithinRel(K, kExact));
  CHECK(std::isnan(estimate_of(result, "mass").low));
  // Standard errors of the frequencies give the interval: d m / d omega_0 = -2 (m + 20) m / (20 omega_0) ...
  rows.sigma = {0.01, 0.01};
  result = added_mass(rows);
  const double by_first = 2.0 * M / 20.0 * (M + 20.0) / rows.omega[0],
               by_second = by_first * rows.omega[0] / rows.omega[1];
  CHECK_THAT(estimate_of(result, "mass").standard_error,
             WithinRel(0.01 * std::hypot(by_first, by_second), 1e-8));
  CHECK_THAT(estimate_of(result, "mass").high - M,
             WithinRel(1.959963985 * estimate_of(result, "mass").standard_error, 1e-8));
}

TEST_CASE("Of a hundred noisy sets of frequencies the intervals hold mass and stiffness in ninety at least") {
  const double M = 102.66, K = 57267.0;
  for (const bool known : {false, true}) {
    AddedMassRows rows{.added = {0.0, 5.0, 10.0, 15.0, 20.0}, .omega = {}, .sigma = {}};
    for (const double added : rows.added) rows.omega.push_back(std::sqrt(K / (M + added)));
    if (known) rows.sigma.assign(5, 0.01);
    std::vector<Truth> truths{{"mass", M}, {"stiffness", K}};
    count_held(truths, [&](unsigned seed) {
      AddedMassRows noisy = rows;
      noisy.omega = Noise(seed).on(rows.omega, 0.01);
      return added_mass(noisy);
    });
    for (const Truth& truth : truths) {
      INFO(truth.name << " held " << truth.held << " sigmas known " << known);
      CHECK(truth.held >= kHeld);
    }
  }
}

TEST_CASE(
    "Degrees of freedom of the frequencies' errors make those of mass and stiffness, by "
    "Welch-Satterthwaite") {
  AddedMassRows rows{.added = {0.0, 20.0}, .omega = {24.0, 22.0}, .sigma = {0.01, 0.01}};
  rows.degrees_of_freedom = {8.0, 8.0};
  const Identification both = added_mass(rows);
  REQUIRE(both.failure == "");
  // m = 20 w_2^2 / (w_1^2 - w_2^2): its parts are as w_2 to w_1. nu = 8 (1 + q)^2 / (1 + q^2), q =
  // (w_2/w_1)^2
  const double q = 22.0 * 22.0 / (24.0 * 24.0);
  const Estimate& mass = estimate_of(both, "mass");
  CHECK_THAT(mass.degrees_of_freedom, WithinRel(8.0 * (1.0 + q) * (1.0 + q) / (1.0 + q * q), 1e-8));
  CHECK(mass.high - mass.value > 2.1 * mass.standard_error);  // t of 16 is 2.12
  // Only what is known badly counts.
  rows.degrees_of_freedom = {4.0, std::numeric_limits<double>::infinity()};
  rows.sigma = {0.01, 1e-9};
  CHECK_THAT(estimate_of(added_mass(rows), "stiffness").degrees_of_freedom, WithinRel(4.0, 1e-8));
  rows.degrees_of_freedom = {4.0};
  CHECK_THAT(added_mass(rows).failure, Contains("degrees of freedom of 1"));
  rows.degrees_of_freedom = {4.0, 0.0};
  CHECK_THAT(added_mass(rows).failure, Contains("must be positive"));
}

TEST_CASE("Added masses that tell nothing are refused") {
  const auto refused = [](std::vector<double> added, std::vector<double> omega) {
    return added_mass({.added = added, .omega = omega, .sigma = {}}).failure;
  };
  CHECK_THAT(refused({1.0, 1.0}, {20.0, 19.0}), Contains("two different added masses"));
  CHECK_THAT(refused({0.0, 1.0}, {20.0, 21.0}), Contains("do not fall"));
  CHECK_THAT(refused({0.0, -1.0}, {20.0, 21.0}), Contains("must not be negative"));
  CHECK_THAT(refused({0.0, 1.0}, {20.0, 0.0}), Contains("frequency 2 of 2 is 0"));
  CHECK_THAT(added_mass({.added = {0.0, 1.0}, .omega = {20.0, 19.0}, .sigma = {0.1}}).failure,
             Contains("1 standard errors for 2 frequencies"));
}

}  // namespace
}  // namespace frahm::identification::energy_loss_test
