#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solvers/mechanics/element_table.hpp"
#include "tests/known_answers/event_integrator.hpp"
#include "tests/known_answers/random_network.hpp"
#include "tests/known_answers/responses.hpp"

// What holds for every network: energy balance, stability, periodicity, extremes, symmetry, units.
namespace frahm::periodic::random_networks_test {
namespace {

using Catch::Matchers::WithinAbs;
constexpr double kBalance = 1e-10;
constexpr double kResidual = 1e-12;
constexpr double kUnstable = 1.0 + 1e-9;
constexpr double kClosure = 1e-8;   // relative to the largest displacement or velocity
constexpr double kExtreme = 1e-10;  // relative

// One period of an independent integration from the response's own state returns to it.
void check_period(const RandomNetwork& drawn, const Responses& responses, const History& history) {
  const mechanics::Assembly assembly(drawn.network);
  mechanics::LinearSystem system;
  assembly.set_values(drawn.values, system);
  assembly.set_forcing(drawn.values, system);
  const Eigen::Index n = system.masses();
  Eigen::VectorXd q(n), v(n), s(system.internal_forces());
  double largest = 1e-4, fastest = 0.0;  // [m]: the static response is near 1 m
  for (Eigen::Index i = 0; i < n; ++i) {
    q[i] = history.columns[static_cast<std::size_t>(2 * i)][0];
    v[i] = history.columns[static_cast<std::size_t>(2 * i + 1)][0];
    const std::string& name = drawn.network.masses[static_cast<std::size_t>(i)];
    largest = std::max(largest, responses[name + "_peak"]);
    fastest = std::max(fastest, responses[name + "_velocity_peak"]);
  }
  Eigen::Index maxwell = 0;
  for (std::size_t e = 0; e < drawn.network.elements.size(); ++e) {
    if (drawn.network.elements[e].type != mechanics::ElementType::maxwell) continue;
    s[maxwell++] = history.columns[2 * drawn.network.masses.size() + e][0];
  }
  EventIntegrator reference(system);
  reference.start(0.0, q, v, s);
  reference.advance_to(2.0 * std::numbers::pi / drawn.values.omega);
  CHECK((reference.displacements() - q).cwiseAbs().maxCoeff() <=
        kClosure * std::max(largest, fastest / drawn.values.omega));
  CHECK((reference.velocities() - v).cwiseAbs().maxCoeff() <=
        kClosure * std::max(fastest, drawn.values.omega * largest));
}

// No sample lies beyond an extreme, and one comes close.
void check_extremes(const RandomNetwork& drawn, const Responses& responses, const History& history) {
  constexpr double kSampling = 1e-3;  // of 2000 samples a period
  for (std::size_t i = 0; i < drawn.network.masses.size(); ++i) {
    double sampled = 0.0;
    for (const double x : history.columns[2 * i]) sampled = std::max(sampled, std::abs(x));
    const double peak = responses[drawn.network.masses[i] + "_peak"];
    CHECK(sampled <= peak * (1.0 + kExtreme) + kExtreme);
    CHECK(sampled >= peak * (1.0 - kSampling) - kExtreme);
  }
}

void check_network(const RandomNetwork& drawn) {
  Responses responses(drawn.network);
  const ResponseSummary& summary = responses.solve(drawn.values);
  INFO("status " << responses["status"] << " " << summary.reason);
  CHECK((responses["status"] == 1.0 || responses["status"] == 2.0));
  CHECK(responses["residual"] < kResidual);
  CHECK(responses["energy_balance"] < kBalance);
  CHECK(responses["floquet_radius"] <= kUnstable);
  if (responses["status"] == 4.0) return;
  const History history = responses.response().history(frahm::periodic::phases_of_a_period(2001));
  check_extremes(drawn, responses, history);
  check_period(drawn, responses, history);
}

// `trials` of each number of masses and contacts, from the one given on.
void check_networks(unsigned first, unsigned trials) {
  const std::vector<std::vector<int>> orders = {{1}, {1, 3}, {1, 2}, {2}, {0, 1}};
  for (const int masses : {1, 2, 3, 5}) {
    for (const int contacts : {0, 1, 2, 3}) {
      for (unsigned trial = first; trial < first + trials; ++trial) {
        std::mt19937 random(1000U * static_cast<unsigned>(masses) + 100U * static_cast<unsigned>(contacts) +
                            trial);
        const RandomNetwork drawn = random_network({.masses = masses,
                                                    .contacts = contacts,
                                                    .orders = orders[trial % orders.size()],
                                                    .shaken = trial % 2 == 0,
                                                    .largest_friction = trial % 3 == 0 ? 2.0 : 0.5},
                                                   random);
        INFO("masses " << masses << " contacts " << contacts << " trial " << trial);
        check_network(drawn);
      }
    }
  }
}

TEST_CASE(
    "Random networks of 1 to 5 masses with up to 3 contacts balance, are stable and return to themselves",
    "[slow]") {
  check_networks(0, 6);
}

TEST_CASE("So do 224 more networks of 1 to 5 masses with up to 3 contacts", "[long]") {
  check_networks(6, 14);
}

TEST_CASE("So do networks with Maxwell and hysteretic elements", "[slow]") {
  const std::vector<std::vector<int>> orders = {{1}, {1, 3}, {1, 2}, {0, 1}};
  for (unsigned trial = 0; trial < 60; ++trial) {
    std::mt19937 random(7000U + trial);
    INFO("trial " << trial);
    check_network(random_network({.masses = 1 + static_cast<int>(trial % 4),
                                  .contacts = static_cast<int>(trial % 3),
                                  .maxwell_elements = 1 + static_cast<int>(trial / 4 % 3),
                                  .hysteretic = trial % 2 == 1,
                                  .orders = orders[trial / 2 % orders.size()],
                                  .shaken = trial % 5 != 0,
                                  .largest_friction = trial % 3 == 0 ? 2.0 : 0.5},
                                 random));
  }
}

TEST_CASE("Under odd forcing every mean is zero") {
  for (unsigned trial = 0; trial < 40; ++trial) {
    std::mt19937 random(trial);
    const RandomNetwork drawn = random_network(
        {.masses = 1 + static_cast<int>(trial % 3), .contacts = 2, .orders = {1, 3}, .largest_friction = 0.4},
        random);
    Responses responses(drawn.network);
    responses.solve(drawn.values);
    INFO("trial " << trial);
    for (const std::string& mass : drawn.network.masses) {
      CHECK_THAT(responses[mass + "_mean"], WithinAbs(0.0, 1e-12));
      CHECK_THAT(responses[mass + "_amplitude"], WithinAbs(responses[mass + "_peak"], 1e-12));
    }
  }
}

TEST_CASE("Other units of length, time and force change the numbers and not the motion") {
  constexpr double kInvariance = 1e-10;
  constexpr double kLength = 1e-3, kTime = 3.7, kForce = 250.0;  // new unit in old ones
  for (unsigned trial = 0; trial < 20; ++trial) {
    std::mt19937 random(500 + trial);
    const RandomNetwork drawn = random_network({.masses = 1 + static_cast<int>(trial % 3),
                                                .contacts = 2,
                                                .maxwell_elements = static_cast<int>(trial % 2),
                                                .hysteretic = trial % 4 > 1,
                                                .orders = {1, 2},
                                                .largest_friction = 0.4},
                                               random);
    mechanics::NetworkValues scaled = drawn.values;
    const double per_length = kForce / kLength;
    scaled.omega /= kTime;
    for (double& mass : scaled.mass) mass *= per_length * kTime * kTime;
    const auto unit_of = [&](mechanics::Dimension dimension) {
      switch (dimension) {
        case mechanics::Dimension::stiffness:
          return per_length;
        case mechanics::Dimension::damping:
          return per_length * kTime;
        case mechanics::Dimension::inertance:
          return per_length * kTime * kTime;
        case mechanics::Dimension::force:
          return kForce;
        case mechanics::Dimension::inverse_speed:
          return kTime / kLength;
        case mechanics::Dimension::cubic_stiffness:
          return per_length / (kLength * kLength);
        case mechanics::Dimension::number:
          break;
      }
      return 1.0;
    };
    for (std::size_t e = 0; e < scaled.element.size(); ++e) {
      const mechanics::ElementKind& kind = mechanics::kind_of(drawn.network.elements[e]);
      scaled.element[e] *= unit_of(kind.value.dimension);
      if (kind.second.exists()) scaled.second[e] *= unit_of(kind.second.dimension);
    }
    for (std::size_t k = 0; k < scaled.excitation.size(); ++k) {
      const bool is_force = drawn.network.excitations[k].kind == mechanics::ExcitationKind::force;
      scaled.excitation[k].amplitude *= is_force ? kForce : kLength;
    }
    Responses before(drawn.network), after(drawn.network);
    before.solve(drawn.values);
    after.solve(scaled);
    INFO("trial " << trial);
    for (const std::string& mass : drawn.network.masses) {
      CHECK(std::abs(after[mass + "_peak"] / kLength - before[mass + "_peak"]) < kInvariance);
      CHECK(std::abs(after[mass + "_velocity_peak"] * kTime / kLength - before[mass + "_velocity_peak"]) <
            kInvariance);
    }
    CHECK(std::abs(after["energy_input"] / (kForce * kLength) - before["energy_input"]) < kInvariance);
    CHECK(after["events"] == before["events"]);
    CHECK(after["status"] == before["status"]);
    CHECK_THAT(after["floquet_radius"], WithinAbs(before["floquet_radius"], 1e-8));
  }
}

TEST_CASE("A response does not depend on the frequencies visited before it") {
  constexpr double kAgreement = 1e-10;
  std::mt19937 random(77);
  const RandomNetwork drawn =
      random_network({.masses = 2, .contacts = 2, .orders = {1}, .largest_friction = 0.4}, random);
  Responses wandering(drawn.network), fresh(drawn.network);
  wandering.solve(drawn.values);
  // There and back, repeated frequencies, wide jumps.
  for (const double factor :
       {1.0, 1.2, 1.0, 1.2, 1.0, 1.0, 0.3, 3.0, 1.01, 1.02, 1.03, 1.0, 6.0, 0.2, 1.0 + 1e-12, 1.0}) {
    mechanics::NetworkValues values = drawn.values;
    values.omega *= factor;
    wandering.follow(values);
    fresh.solve(values);
    INFO("factor " << factor);
    REQUIRE(wandering["status"] == fresh["status"]);
    for (const std::string& mass : drawn.network.masses) {
      CHECK(std::abs(wandering[mass + "_peak"] - fresh[mass + "_peak"]) < kAgreement);
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::random_networks_test
