#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "tests/known_answers/exponential_integrator.hpp"
#include "tests/known_answers/random_network.hpp"
#include "tests/known_answers/responses.hpp"

// The responses of networks of monotone laws, drawn at random, next to what an independent integration comes
// to from rest: it knows nothing of the response, not even a state of it. Their response is one, so that both
// must agree.
namespace frahm::periodic::from_rest_test {
namespace {

constexpr double kSettled = 1e-10;  // change of the velocities in a period, of the fastest
constexpr double kAgrees = 1e-7;    // of the largest: what is left of the transient when it counts as settled
constexpr int kMostPeriods = 4000;
constexpr double kFewUnsettled = 0.05;  // of the networks: hardly damped ones need thousands of periods

RandomNetwork draw(unsigned trial) {
  const std::vector<std::vector<int>> orders = {{1}, {0, 1, 2}, {1, 3}, {1, 2}};
  std::mt19937 random(900000U + trial);
  const auto pick = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  RandomNetworkOptions options;
  options.masses = 1 + static_cast<int>(trial % 4);
  options.contacts = static_cast<int>(trial / 4 % 4);
  options.jenkins_elements = pick(4) == 0 ? 1 : 0;
  options.maxwell_elements = pick(4) == 0 ? 1 : 0;
  options.orders = orders[static_cast<std::size_t>(pick(4))];
  options.shaken = pick(2) == 0;
  options.largest_friction = pick(3) == 0 ? 2.0 : 0.5;
  return random_network(options, random);
}

// Whether the motion from rest repeats itself after at most kMostPeriods; the last period's extremes are
// watched.
bool settles(ExponentialIntegrator& reference) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(reference.masses());
  reference.watches_extremes = false;
  reference.start(zero, zero, Eigen::VectorXd::Zero(reference.state().size() - 2 * reference.masses()));
  double fastest = 0.0;
  for (int period = 0; period < kMostPeriods; ++period) {
    const Eigen::VectorXd before = reference.state();
    reference.pass_period();
    fastest = std::max(fastest, reference.velocities().cwiseAbs().maxCoeff());
    if ((reference.state() - before).cwiseAbs().maxCoeff() > kSettled * std::max(fastest, 1e-3)) continue;
    const Eigen::VectorXd state = reference.state(), q = reference.displacements(),
                          v = reference.velocities();
    reference.watches_extremes = true;
    reference.start(q, v, state.tail(state.size() - 2 * reference.masses()));
    reference.pass_period();
    return true;
  }
  return false;
}

// How many of these networks, each given by its number, do not settle or are too much for the reference.
int check_networks(unsigned first, unsigned count) {
  int unsettled = 0;
  for (unsigned trial = first; trial < first + count; ++trial) {
    const RandomNetwork drawn = draw(trial);
    ExponentialIntegrator reference(drawn.network, drawn.values);
    try {
      if (!settles(reference)) {
        ++unsettled;
        continue;
      }
    } catch (const std::runtime_error& error) {
      WARN("network " << trial << ": " << error.what());
      ++unsettled;
      continue;
    }
    Responses responses(drawn.network);
    const ResponseSummary& summary = responses.solve(drawn.values);
    INFO("network " << trial << ", status " << responses["status"] << " " << summary.reason);
    double largest = 1e-4;  // [m]: statically about 1 m
    for (const std::string& mass : drawn.network.masses)
      largest = std::max(largest, responses[mass + "_peak"]);
    for (Eigen::Index i = 0; i < reference.masses(); ++i) {
      const double own = responses[drawn.network.masses[static_cast<std::size_t>(i)] + "_amplitude"];
      CHECK(std::abs(reference.amplitude(i) - own) < kAgrees * largest);
    }
  }
  return unsettled;
}

TEST_CASE("From rest an independent integration of 60 random networks comes to the responses found") {
  constexpr int kNetworks = 60;
  CHECK(check_networks(0, kNetworks) <= kFewUnsettled * kNetworks);
}

// Minutes: test_from_rest "[thorough]", which `./bootstrap checks` runs.
TEST_CASE("So does that of 1000", "[.thorough]") {
  constexpr int kNetworks = 1000;
  const int unsettled = check_networks(0, kNetworks);
  WARN(unsettled << " of " << kNetworks << " not settled after " << kMostPeriods << " periods");
  CHECK(unsettled <= kFewUnsettled * kNetworks);
}

}  // namespace
}  // namespace frahm::periodic::from_rest_test
