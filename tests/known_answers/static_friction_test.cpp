#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "solvers/transient/forced_motion.hpp"
#include "tests/known_answers/static_friction_reference.hpp"

// Contacts that hold more at rest than they do sliding, and share masses: who slides.
namespace frahm::transient::static_friction_test {
namespace {

using Catch::Matchers::Contains, Catch::Matchers::WithinAbs;
using mechanics::ElementType, mechanics::ExcitationKind, mechanics::Network, mechanics::NetworkValues,
    mechanics::Node, mechanics::NodeKind;

const Node kGround{};
Node mass(std::size_t i) {
  return {NodeKind::mass, i};
}

struct Drawn {
  Network network;
  NetworkValues values;

  void add_mass(double kg) {
    network.masses.push_back("m" + std::to_string(network.masses.size()));
    values.mass.push_back(kg);
  }
  void add(ElementType type, Node a, Node b, double value, double static_force = 0.0) {
    network.elements.push_back({"e" + std::to_string(network.elements.size()), type, a, b});
    network.elements.back().has_static_force = static_force > 0.0;
    values.element.push_back(value);
    values.second.push_back(static_force);
  }
  void push(std::size_t on, double amplitude, int order, double phase = 0.0) {
    network.excitations.push_back({ExcitationKind::force, on, order});
    values.excitation.push_back({amplitude, phase});
  }
  ForcedMotion moved(double duration, const InitialState& initial, int samples) const {
    return forced_motion(network, [this](double) { return values; }, initial,
                         {.from = values.omega, .duration = duration, .samples = samples});
  }
};

TEST_CASE("A plate stays at rest under the sledge that slides off") {
  // Ground and plate 2 N sliding, 2.4 N at rest; plate and sledge 5 N and 11 N; 1 kg each. The sledge is
  // pushed with 17 N > 11 N, so that the plate bears 5 - 6.6 = -1.6 N; the sledge goes off with 12 m/s2, 0.06
  // m in 0.1 s.
  Drawn drawn;
  drawn.add_mass(1.0);
  drawn.add_mass(1.0);
  constexpr double kSoft = 1e-6;  // [N/m]; of 0.06 m it makes 1e-8 N
  drawn.add(ElementType::spring, kGround, mass(0), kSoft);
  drawn.add(ElementType::spring, kGround, mass(1), kSoft);
  drawn.add(ElementType::coulomb, mass(1), mass(0), 5.0, 11.0);
  drawn.add(ElementType::coulomb, kGround, mass(1), 2.0, 2.4);
  drawn.push(0, 17.0, 0);
  drawn.push(1, -6.6, 0);
  drawn.values.omega = 1.0;
  const ForcedMotion motion = drawn.moved(0.1, {}, 3);
  REQUIRE(motion.failure.empty());
  CHECK_THAT(motion.history.displacement[0].back(), WithinAbs(0.06, 1e-10));
  CHECK(motion.history.displacement[1].back() == 0.0);
  REQUIRE(motion.stops[1].size() == 1);
  CHECK(std::isnan(motion.stops[1][0].release));
  CHECK(motion.energy.balance < 1e-12);
}

TEST_CASE("A block at rest stays where the one on it stops and slides back") {
  // 2 kg on the ground, 4 N sliding, 6 N at rest; on it 1.2 kg, 2 N and 4 N; -2.2 N and -5 N. The upper one
  // is thrown forward with 1 m/s, stops under -7 N / 1.2 kg after 0.1714 s, and slides back under -3 N: the
  // lower one bears 2.2 N + 2 N < 6 N.
  Drawn drawn;
  drawn.add_mass(2.0);
  drawn.add_mass(1.2);
  constexpr double kSoft = 0.01;  // [N/m]
  drawn.add(ElementType::spring, kGround, mass(0), kSoft);
  drawn.add(ElementType::spring, kGround, mass(1), kSoft);
  drawn.add(ElementType::coulomb, kGround, mass(0), 4.0, 6.0);
  drawn.add(ElementType::coulomb, mass(0), mass(1), 2.0, 4.0);
  drawn.push(0, -2.2, 0);
  drawn.push(1, -5.0, 0);
  drawn.values.omega = 1.0;
  const ForcedMotion motion = drawn.moved(0.5, {{}, {0.0, 1.0}}, 11);
  REQUIRE(motion.failure.empty());
  CHECK(motion.history.displacement[0].back() == 0.0);
  REQUIRE(motion.stops[0].size() == 1);
  CHECK(std::isnan(motion.stops[0][0].release));
  CHECK(motion.stops[1].empty());
  // x'' = -p - 2 x/240 from rest at x = 0.6/7, p = 2.5: there the spring pulls with less than 1e-3 N
  const double top = 0.5 * 1.2 / 7.0, later = 0.5 - 1.2 / 7.0;
  CHECK_THAT(motion.history.displacement[1].back(), WithinAbs(top - 0.5 * 2.5 * later * later, 1e-4));
  CHECK(motion.energy.balance < 1e-12);
}

// One to three masses on the ground and on one another, half of them with contacts on masses of their own.
Drawn draw(unsigned trial, static_friction::System& system) {
  std::mt19937 random(5300000U + trial);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto spread = [&](double decades) { return std::pow(10.0, decades * (uniform(random) - 0.5)); };
  const auto pick = [&](std::size_t count) { return random() % count; };
  const bool shares = trial % 2 == 0;
  const std::size_t n = shares ? 2 + trial / 2 % 2 : 1 + trial / 2 % 3;
  const auto size = static_cast<Eigen::Index>(n);
  Drawn drawn;
  system.mass.resize(size);
  system.K.setZero(size, size);
  system.C.setZero(size, size);
  system.constant.setZero(size);
  system.cosine.setZero(size);
  system.sine.setZero(size);
  const auto direction = [&](std::size_t a, std::size_t b) {  // n: the ground
    Eigen::VectorXd w = Eigen::VectorXd::Zero(size);
    if (a < n) w[static_cast<Eigen::Index>(a)] -= 1.0;
    w[static_cast<Eigen::Index>(b)] += 1.0;
    return w;
  };
  const auto node = [&](std::size_t i) { return i < n ? mass(i) : kGround; };
  for (std::size_t i = 0; i < n; ++i) {
    drawn.add_mass(spread(1.0));
    system.mass[static_cast<Eigen::Index>(i)] = drawn.values.mass.back();
  }
  const auto add = [&](std::size_t a, std::size_t b, double k, double c) {
    const Eigen::VectorXd w = direction(a, b);
    drawn.add(ElementType::spring, node(a), node(b), k);
    drawn.add(ElementType::damper, node(a), node(b), c);
    system.K += k * w * w.transpose();
    system.C += c * w * w.transpose();
  };
  for (std::size_t i = 0; i < n; ++i) add(n, i, spread(1.0), 0.1 * spread(1.5));
  for (std::size_t i = 1; i < n; ++i) add(i - 1, i, spread(1.0), 0.1 * spread(1.5));
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  // each but once: two between the same act as one
  for (std::size_t i = 0; i < n; ++i) pairs.emplace_back(n, i);
  for (std::size_t i = 1; shares && i < n; ++i)
    for (std::size_t k = 0; k < i; ++k) pairs.emplace_back(k, i);
  std::shuffle(pairs.begin(), pairs.end(), random);
  const std::size_t contacts = shares ? 2 + pick(std::min<std::size_t>(pairs.size(), 4) - 1) : 1 + pick(n);
  for (std::size_t j = 0; j < contacts; ++j) {
    const auto [a, b] = pairs[j];
    const double force = 0.05 + 0.6 * uniform(random);
    const double ratio = pick(6) == 0 ? 1.0 : 1.0 + 2.0 * uniform(random);
    drawn.add(ElementType::coulomb, node(a), node(b), force, ratio * force);
    system.contacts.push_back({direction(a, b), force, ratio * force});
  }
  drawn.values.omega = system.omega = spread(1.0);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (pick(2) == 0) {
      const double steady = 1.5 * (uniform(random) - 0.5);
      drawn.push(i, steady, 0);
      system.constant[row] = steady;
    }
    if (i > 0 && pick(3) == 0) continue;
    const double amplitude = 0.3 + 1.2 * uniform(random), phase = 2.0 * std::numbers::pi * uniform(random);
    drawn.push(i, amplitude, 1, phase);
    system.cosine[row] = amplitude * std::cos(phase);
    system.sine[row] = -amplitude * std::sin(phase);
  }
  return drawn;
}

struct Tally {
  int agree = 0, near = 0, none_admissible = 0, wrong = 0, chatters = 0, events = 0;
};

constexpr double kAgrees = 1e-8;  // of times in periods and of displacements in the largest peak

// The first difference; empty: there is none.
std::string difference_of_stops(const std::vector<std::vector<Stop>>& own,
                                const static_friction::Motion& right, double tolerance) {
  std::ostringstream text;
  text.precision(12);
  for (std::size_t j = 0; j < own.size(); ++j) {
    for (std::size_t i = 0; i < std::max(own[j].size(), right.stops[j].size()); ++i) {
      text << "contact " << j << " stop " << i << ": ";
      const bool has_own = i < own[j].size(), has_right = i < right.stops[j].size();
      if (has_own) text << own[j][i].onset << " to " << own[j][i].release;
      if (has_right) text << " for " << right.stops[j][i].onset << " to " << right.stops[j][i].release;
      if (has_own != has_right) return text.str();
      const static_friction::Stop& stop = right.stops[j][i];
      if (std::abs(own[j][i].onset - stop.onset) > tolerance) return text.str();
      if (std::isnan(own[j][i].release) != (stop.release < 0.0)) return text.str();
      if (stop.release >= 0.0 && std::abs(own[j][i].release - stop.release) > tolerance) return text.str();
      text.str("");
    }
  }
  return "";
}

std::string difference_of_places(const ForcedMotion& own, const static_friction::Motion& right) {
  constexpr double kCreeps = 1e-10;  // [m]: of a mass at rest, rounding of the reference
  const double tolerance = kAgrees * right.peak.maxCoeff() + kCreeps;
  std::ostringstream text;
  text.precision(12);
  for (Eigen::Index i = 0; i < right.peak.size(); ++i) {
    const auto m = static_cast<std::size_t>(i);
    const double peak = std::abs(own.peaks[m].displacement), end = own.history.displacement[m].back();
    if (std::abs(peak - right.peak[i]) <= tolerance && std::abs(end - right.end[i]) <= tolerance) continue;
    text << "mass " << i << ": peak " << peak << " for " << right.peak[i] << ", end " << end << " for "
         << right.end[i];
    return text.str();
  }
  return "";
}

Tally follow_systems(unsigned first, unsigned count) {
  Tally tally;
  for (unsigned trial = first; trial < first + count; ++trial) {
    static_friction::System system;
    const Drawn drawn = draw(trial, system);
    const double period = 2.0 * std::numbers::pi / system.omega, duration = 6.0 * period;
    static_friction::Motion right;
    try {
      right = static_friction::follow(system, duration);
    } catch (const std::runtime_error&) {
      ++tally.chatters;
      continue;
    }
    const ForcedMotion own = drawn.moved(duration, {}, 2);
    if (right.is_near) {
      ++tally.near;
      continue;
    }
    std::string difference = right.has_none_admissible ? "none is admissible" : "";
    if (own.failure.empty() && difference.empty()) {
      difference = difference_of_stops(own.stops, right, kAgrees * period);
      if (difference.empty()) difference = difference_of_places(own, right);
    } else if (right.has_none_admissible != own.failure.empty()) {
      difference = "";
    }
    INFO("system " << trial << ": " << own.failure << " " << difference);
    const bool agrees = difference.empty() && right.has_none_admissible == !own.failure.empty();
    tally.none_admissible += agrees && right.has_none_admissible;
    tally.agree += agrees && !right.has_none_admissible;
    tally.wrong += !agrees;
    tally.events += right.events;
    CHECK(agrees);
  }
  return tally;
}

void check(unsigned count) {
  constexpr double kDecided = 0.95;  // of the systems no decision lies within 1e-6 of its limit
  const Tally tally = follow_systems(0, count);
  INFO(tally.agree << " agree, " << tally.near << " near a limit, " << tally.none_admissible
                   << " without an admissible choice, " << tally.wrong << " wrong, " << tally.chatters
                   << " too much for the reference, " << tally.events << " events");
  const auto all = static_cast<int>(count);
  CHECK(tally.wrong == 0);
  CHECK(tally.agree > kDecided * all);
  CHECK(tally.chatters == 0);
}

TEST_CASE("2000 random systems with static friction move from rest as an independent integration says",
          "[slow]") {
  check(2000);
}

}  // namespace
}  // namespace frahm::transient::static_friction_test
