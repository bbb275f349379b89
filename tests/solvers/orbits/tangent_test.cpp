#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solvers/events/walk.hpp"
#include "tests/known_answers/random_network.hpp"

// The derivative of the flow through its events, product of flow and saltation matrices, against differences.
namespace frahm::periodic::tangent_test {
namespace {

constexpr double kAgreement = 1e-6;  // relative to the largest entry, in the energy norm's scaling
constexpr int kAny = Eigen::Dynamic;
using AnyFlow = Flow<kAny, kAny>;

bool same_sequence(const AnyFlow& flow, const Passage<kAny, kAny>& a, const Passage<kAny, kAny>& b) {
  if (a.segments.size() != b.segments.size()) return false;
  for (std::size_t i = 0; i < a.segments.size(); ++i) {
    const auto &p = flow.mode(a.segments[i].mode), &q = flow.mode(b.segments[i].mode);
    if (p.stuck != q.stuck || p.positive != q.positive || p.beyond != q.beyond) return false;
  }
  return true;
}

// Central differences of the flow, column by column; false where a neighbour goes through other events.
bool difference(AnyFlow& flow, const Eigen::VectorXd& z, double length, const Passage<kAny, kAny>& centre,
                Eigen::MatrixXd& result) {
  constexpr double kStep = 1e-6;
  result.resize(z.size(), z.size());
  Passage<kAny, kAny> ahead, behind;
  for (Eigen::Index column = 0; column < z.size(); ++column) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(z.size(), column);
    Walk(flow).pass(z + step, 0.3, length, ahead);
    Walk(flow).pass(z - step, 0.3, length, behind);
    if (!same_sequence(flow, centre, ahead) || !same_sequence(flow, centre, behind)) return false;
    result.col(column) = (ahead.end - behind.end) / (2.0 * kStep);
  }
  return true;
}

struct Compared {
  int passages = 0, events = 0, stuck_segments = 0, bent_segments = 0;
};

// A period from a random state.
void compare(const RandomNetwork& drawn, std::mt19937& random, Compared& compared) {
  std::normal_distribution<double> normal;
  const mechanics::Assembly assembly(drawn.network);
  mechanics::LinearSystem system;
  assembly.set_values(drawn.values, system);
  assembly.set_forcing(drawn.values, system);
  AnyFlow flow;
  flow.set_system(system);
  flow.set_forcing(system);
  const Eigen::VectorXd z = Eigen::VectorXd::NullaryExpr(2 * system.masses(), [&] { return normal(random); });
  Passage<kAny, kAny> passage;
  Walk(flow).pass(z, 0.3, flow.equations().period, passage);
  REQUIRE(passage.failure == nullptr);
  Eigen::MatrixXd expected;
  if (passage.margin < 1e-3 || !difference(flow, z, flow.equations().period, passage, expected)) return;
  INFO("events " << passage.events);
  CHECK((passage.tangent - expected).cwiseAbs().maxCoeff() <
        kAgreement * std::max(1.0, expected.cwiseAbs().maxCoeff()));
  ++compared.passages;
  compared.events += passage.events;
  for (const auto& segment : passage.segments) {
    compared.stuck_segments += flow.mode(segment.mode).stuck != 0;
    compared.bent_segments += flow.mode(segment.mode).beyond != 0;
  }
}

TEST_CASE("The derivative through stops, releases and reversals is that of differences, for 1 to 9 masses") {
  std::mt19937 random(11);
  Compared compared;
  for (const int masses : {1, 2, 3, 5, 9}) {  // from 8 on along its path
    for (const int contacts : {0, 1, 2, 3}) {
      for (int trial = 0; trial < 25; ++trial) {
        INFO("masses " << masses << " contacts " << contacts << " trial " << trial);
        compare(
            random_network(
                {.masses = masses, .contacts = contacts, .orders = {1, 2}, .largest_friction = 0.7}, random),
            random, compared);
      }
    }
  }
  CHECK(compared.passages > 200);
  CHECK(compared.events > 400);
  CHECK(compared.stuck_segments > 200);
}

TEST_CASE("So is that through elastic stops, bends of dampers and falls from a static limit") {
  std::mt19937 random(13);
  Compared compared;
  for (const int masses : {1, 2, 3, 9}) {
    for (int trial = 0; trial < 40; ++trial) {
      INFO("masses " << masses << " trial " << trial);
      compare(random_network({.masses = masses,
                              .contacts = trial % 3,
                              .rising_dampers = trial / 3 % 2,
                              .stops = 1 + trial / 6 % 2,
                              .static_friction = true,
                              .orders = {1, 2},
                              .largest_friction = 0.7},
                             random),
              random, compared);
    }
  }
  CHECK(compared.passages > 80);
  CHECK(compared.stuck_segments > 60);
  CHECK(compared.bent_segments > 200);
}

TEST_CASE("The distance of two motions never grows in the energy norm") {
  constexpr double kRounding = 1e-12;
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 300; ++trial) {
    const int masses = std::vector<int>{1, 2, 3, 5}[static_cast<std::size_t>(trial % 4)];
    const RandomNetwork drawn = random_network(
        {.masses = masses, .contacts = trial % 5 % 4, .orders = {1, 3}, .largest_friction = 2.0}, random);
    const mechanics::Assembly assembly(drawn.network);
    mechanics::LinearSystem system;
    assembly.set_values(drawn.values, system);
    assembly.set_forcing(drawn.values, system);
    AnyFlow flow;
    flow.set_system(system);
    flow.set_forcing(system);
    Passage<kAny, kAny> first, second;
    Eigen::VectorXd a = Eigen::VectorXd::NullaryExpr(2 * masses, [&] { return normal(random); });
    Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(2 * masses, [&] { return normal(random); });
    double distance = flow.equations().energy_norm(a - b);
    for (int part = 0; part < 10; ++part) {
      const double length = 0.2 * flow.equations().period, phase = part * 0.4 * M_PI;
      Walk(flow).pass(a, phase, length, first);
      Walk(flow).pass(b, phase, length, second);
      a = first.end;
      b = second.end;
      const double now = flow.equations().energy_norm(a - b);
      INFO("trial " << trial << " part " << part);
      CHECK(now <= distance * (1.0 + kRounding) + kRounding);
      distance = now;
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::tangent_test
