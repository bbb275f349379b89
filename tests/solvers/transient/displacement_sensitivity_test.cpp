#include "solvers/transient/displacement_sensitivity.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solvers/transient/forced_motion.hpp"
#include "tests/known_answers/random_network.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Peaks of motions under records and their derivatives, against differences of peaks computed anew.
namespace frahm::transient::displacement_sensitivity_test {
namespace {

using mechanics::ElementType, mechanics::ExcitationKind, mechanics::Network, mechanics::NetworkValues;
using mechanics::Node, mechanics::NodeKind;

constexpr double kDuration = 12.0;     // [s]
constexpr double kDifference = 2e-6;   // of derivatives and differences, relative to the largest of a peak
constexpr double kUndecided = 5e-7;    // a difference that knows itself no better, likewise, decides nothing
constexpr double kSame = 1e-11;        // of the same displacement by two ways, relative
constexpr double kClosedForm = 1e-10;  // relative

Record draw(RecordOf of, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Record record{.name = "drawn", .of = of, .time = {0.0}, .values = {0.0}};
  while (record.time.back() < 10.0) {
    record.time.push_back(record.time.back() + 0.3 + 0.2 * uniform(random));
    record.values.push_back(uniform(random));
  }
  return record;
}

// A random network under a force on its first mass and the acceleration of its support, whose first mass
// has a signal relative to the support.
struct Shaken {
  Network network;
  NetworkValues values;
  Record force, shaking;

  explicit Shaken(int trial, std::mt19937& random)
      : force(draw(RecordOf::force, random)), shaking(draw(RecordOf::acceleration, random)) {
    const auto drawn = periodic::random_network({.masses = 1 + trial % 3,
                                                 .contacts = 1 + trial / 2 % 2,
                                                 .maxwell_elements = trial % 4 == 3 ? 1 : 0,
                                                 .stops = trial % 3 == 2 ? 1 : 0,
                                                 .static_friction = trial % 5 == 4,
                                                 .largest_friction = 0.6},
                                                random);
    network = drawn.network;
    values = drawn.values;
    network.excitations = {{ExcitationKind::recorded_force, 0, 0}, {ExcitationKind::recorded_motion, 0, 0}};
    values.excitation = {{1.0, 0.1}, {0.7, 0.2}};
    network.signals = {{"drift", {{{NodeKind::prescribed, 0}, -1.0}, {{NodeKind::mass, 0}, 1.0}}}};
  }

  std::vector<RecordedExcitation> records() const { return {{0, &force}, {1, &shaking}}; }
  std::vector<Extremum> peaks(const NetworkValues& at) const {
    const ForcedMotion motion =
        forced_motion(network, [&](double) { return at; }, {},
                      {.from = at.omega, .records = records(), .duration = kDuration, .samples = 2});
    INFO(motion.failure);
    REQUIRE(motion.failure.empty());
    return motion.peaks;
  }
};

struct Tally {
  int compared = 0, undecided = 0;
  double worst = 0.0;
};

// Steps relative to the parameter; the two that agree best tell the difference and how well it is known.
void compare(const Shaken& shaken, const periodic::NamedParameter& named, const std::vector<double>& exact,
             const std::vector<double>& sizes, Tally& tally) {
  const double value = named.parameter.value;
  std::vector<std::vector<double>> quotients;
  for (const double relative : {1e-4, 2e-5, 4e-6, 8e-7}) {
    const double step = relative * std::abs(value);
    const auto above = shaken.peaks(named.parameter.values_at(value + step));
    const auto below = shaken.peaks(named.parameter.values_at(value - step));
    quotients.emplace_back();
    for (std::size_t c = 0; c < exact.size(); ++c)
      quotients.back().push_back((std::abs(above[c].displacement) - std::abs(below[c].displacement)) /
                                 (2.0 * step));
  }
  for (std::size_t c = 0; c < exact.size(); ++c) {
    double apart = 1e300, difference = 0.0;
    for (std::size_t s = 0; s + 1 < quotients.size(); ++s) {
      if (!(std::abs(quotients[s][c] - quotients[s + 1][c]) < apart)) continue;
      apart = std::abs(quotients[s][c] - quotients[s + 1][c]);
      difference = quotients[s + 1][c];
    }
    if (apart > kUndecided * sizes[c]) {
      ++tally.undecided;
      continue;
    }
    ++tally.compared;
    tally.worst = std::max(tally.worst, std::abs(exact[c] - difference) / sizes[c]);
    INFO(named.name << ", coordinate " << c << ": exact " << exact[c] << ", difference " << difference);
    CHECK(std::abs(exact[c] - difference) <= kDifference * sizes[c]);
  }
}

TEST_CASE("Derivatives of the peaks of 40 random networks under records are those of differences", "[slow]") {
  std::mt19937 random(20261127);
  Tally tally;
  for (int trial = 0; trial < 40; ++trial) {
    INFO("trial " << trial);
    const Shaken shaken(trial, random);
    auto parameters = periodic::all_parameters(shaken.network, shaken.values);
    std::erase_if(parameters, [](const auto& each) { return each.name == "omega"; });
    std::vector<NetworkValues> along;
    for (const auto& each : parameters) along.push_back(each.parameter.direction);
    const std::vector<Extremum> peaks = shaken.peaks(shaken.values);
    std::vector<std::vector<double>> exact(parameters.size());  // of each parameter, of each coordinate
    for (std::size_t c = 0; c < peaks.size(); ++c) {
      const std::array<double, 1> time{peaks[c].time};
      const DisplacementSensitivity found =
          displacement_sensitivity(shaken.network, shaken.values, along, shaken.records(), c, time, {});
      INFO(found.failure << found.why_none);
      REQUIRE((found.failure.empty() && found.why_none.empty()));
      CHECK(std::abs(found.displacement[0] - peaks[c].displacement) <=
            kSame * std::abs(peaks[c].displacement));
      for (std::size_t p = 0; p < parameters.size(); ++p)
        exact[p].push_back(std::copysign(1.0, peaks[c].displacement) * found.by(0, static_cast<int>(p)));
    }
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      std::vector<double> sizes;
      for (std::size_t c = 0; c < peaks.size(); ++c)
        sizes.push_back(std::abs(peaks[c].displacement) / std::abs(parameters[p].parameter.value) +
                        std::abs(exact[p][c]));
      compare(shaken, parameters[p], exact[p], sizes, tally);
    }
  }
  INFO(tally.compared << " compared, worst " << tally.worst << ", " << tally.undecided << " undecided");
  CHECK(tally.compared > 1500);
  CHECK(tally.undecided < tally.compared / 100);
}

// One mass of 1 kg on a spring k to ground under a force of 1 N from t = 0 on: x = (1 - cos w t)/k.
TEST_CASE("Displacements of an oscillator under a constant force have the derivatives of the closed form") {
  const Network network{.masses = {"m"},
                        .elements = {{"k", ElementType::spring, {}, {NodeKind::mass, 0}}},
                        .excitations = {{ExcitationKind::recorded_force, 0, 0}}};
  const double k = 2.3, w = std::sqrt(k);
  const NetworkValues values{.omega = 1.0, .mass = {1.0}, .element = {k}, .excitation = {{1.0, 0.0}}};
  NetworkValues by_k = periodic::zero_direction(values);
  by_k.element[0] = 1.0;
  const Record constant{.name = "F", .of = RecordOf::force, .time = {0.0, 9.0}, .values = {1.0, 1.0}};
  const std::array<double, 4> times{0.0, 0.8, 2.1, 4.0};
  const DisplacementSensitivity found = displacement_sensitivity(
      network, values, std::span(&by_k, 1), std::vector<RecordedExcitation>{{0, &constant}}, 0, times, {});
  for (int i = 0; i < 4; ++i) {
    const double t = times[static_cast<std::size_t>(i)];
    // dx/dk = -(1 - cos w t)/k^2 + t sin(w t) / (2 w k)
    const double expected = -(1.0 - std::cos(w * t)) / (k * k) + 0.5 * t * std::sin(w * t) / (w * k);
    INFO("t = " << t);
    CHECK(std::abs(found.displacement[i] - (1.0 - std::cos(w * t)) / k) <= kClosedForm);
    CHECK(std::abs(found.by(i, 0) - expected) <= kClosedForm);
  }
}

TEST_CASE("A harmonic beside the records, and a direction that changes the frequency, are refused") {
  Network network{.masses = {"m"},
                  .elements = {{"k", ElementType::spring, {}, {NodeKind::mass, 0}}},
                  .excitations = {{ExcitationKind::recorded_force, 0, 0}}};
  NetworkValues values{.omega = 1.0, .mass = {1.0}, .element = {1.0}, .excitation = {{1.0, 0.0}}};
  const Record force{.name = "F", .of = RecordOf::force, .time = {0.0, 1.0}, .values = {1.0, 1.0}};
  const auto refused = [&](std::span<const NetworkValues> along, const char* word) {
    const std::array<double, 1> times{1.0};
    const std::vector<RecordedExcitation> records{{0, &force}};
    CHECK_THROWS_WITH(displacement_sensitivity(network, values, along, records, 0, times, {}),
                      Catch::Contains(word));
  };
  NetworkValues by_frequency = periodic::zero_direction(values);
  by_frequency.omega = 1.0;
  refused(std::span(&by_frequency, 1), "with respect to a frequency");
  network.excitations.push_back({ExcitationKind::force, 0, 1});
  values.excitation.push_back({1.0, 0.0});
  refused({}, "only constant forces");
}

}  // namespace
}  // namespace frahm::transient::displacement_sensitivity_test
