#include "solvers/events/admissible.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

namespace frahm::periodic::admissible_test {
namespace {

using Catch::Matchers::WithinAbs;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
constexpr double kExact = 1e-12;  // of forces and accelerations near 1

const BrokenClaims kNoneBroken = [](const RestChoice&) { return ContactMask{0}; };

ContactsAtRest at_rest(const MatrixXd& G, const VectorXd& c, const VectorXd& kinetic, const VectorXd& limit) {
  return {.G = G, .free = c, .kinetic = kinetic, .limit = limit};
}

// By trial of all 3^m choices, whose forces are solved for on all contacts at once.
struct Tried {
  bool found = false;
  std::vector<int> way;  // 0: sticks
  VectorXd force;
  double sum = 0.0;
  int sticking = -1, kept = -1;
};
Tried try_all(const ContactsAtRest& rest) {
  const auto m = static_cast<int>(rest.free.size());
  Tried best;
  for (int code = 0, codes = static_cast<int>(std::lround(std::pow(3.0, m))); code < codes; ++code) {
    Tried tried;
    tried.found = true;
    tried.way.resize(static_cast<std::size_t>(m));
    tried.sticking = tried.kept = 0;
    MatrixXd A = rest.G;  // a row for each contact: its acceleration is zero, or its force is known
    VectorXd b = rest.free;
    int left = code;
    for (int i = 0; i < m; ++i, left /= 3) {
      const int way = left % 3 == 2 ? -1 : left % 3;
      tried.way[static_cast<std::size_t>(i)] = way;
      if (way == 0) {
        ++tried.sticking;
        tried.kept += contains(rest.stuck_before, i) ? 1 : 0;
      } else {
        A.row(i).setZero();
        A(i, i) = 1.0;
        b[i] = way * rest.kinetic[i];
      }
    }
    tried.force = A.fullPivLu().solve(b);
    const VectorXd acceleration = rest.free - rest.G * tried.force;
    for (int i = 0; i < m; ++i) {
      const int way = tried.way[static_cast<std::size_t>(i)];
      const bool does = way == 0 ? std::abs(tried.force[i]) <= rest.limit[i] : way * acceleration[i] > 0.0;
      tried.found = tried.found && does;
    }
    tried.sum = tried.force.cwiseQuotient(rest.limit).squaredNorm();
    if (!tried.found || tried.sticking < best.sticking) continue;
    if (tried.sticking == best.sticking && tried.kept < best.kept) continue;
    if (tried.sticking == best.sticking && tried.kept == best.kept && tried.sum >= best.sum) continue;
    best = tried;
  }
  return best;
}

ContactsAtRest draw(Index m, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const MatrixXd root = MatrixXd::NullaryExpr(m + 1, m, [&] { return normal(random); });
  const VectorXd kinetic = VectorXd::NullaryExpr(m, [&] { return 0.2 + uniform(random); });
  const VectorXd ratio = VectorXd::NullaryExpr(m, [&] { return 1.0 + 2.0 * uniform(random); });
  ContactsAtRest rest = at_rest(root.transpose() * root, VectorXd(m), kinetic, kinetic.cwiseProduct(ratio));
  rest.free = rest.G * VectorXd::NullaryExpr(m, [&] { return 1.5 * normal(random); });
  rest.stuck_before = random() % bit(m);
  return rest;
}

TEST_CASE("Of contacts at rest together the choice is that of the trial of all") {
  std::mt19937 random(20261128);
  int several_slide = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Index m = 1 + trial % 5;
    const ContactsAtRest rest = draw(m, random);
    const Tried right = try_all(rest);
    const RestChoice choice = admissible_choice(rest, kNoneBroken);
    INFO("trial " << trial << " of " << m);
    REQUIRE(right.found);  // that for F_s = F is always admissible
    REQUIRE(choice.found);
    several_slide += m - right.sticking > 1;
    for (Index i = 0; i < m; ++i) {
      const int way = right.way[static_cast<std::size_t>(i)];
      CHECK(contains(choice.stuck, i) == (way == 0));
      CHECK(contains(choice.forward, i) == (way == 1));
      CHECK_THAT(choice.force[i], WithinAbs(right.force[i], 1e3 * kExact));
    }
  }
  CHECK(several_slide > 400);
}

TEST_CASE("A plate stays at rest under the sledge that slides off") {
  // Sledge on plate, plate on ground, 1 kg each: G = W^T W. 17 N and -6.6 N.
  MatrixXd G(2, 2);
  G << 2.0, -1.0, -1.0, 1.0;
  const VectorXd c = Eigen::Vector2d(17.0 + 6.6, -6.6);
  const RestChoice choice =
      admissible_choice(at_rest(G, c, Eigen::Vector2d(5.0, 2.0), Eigen::Vector2d(11.0, 2.4)), kNoneBroken);
  REQUIRE(choice.found);
  CHECK(choice.stuck == bit(1));
  CHECK(choice.forward == bit(0));
  CHECK_THAT(choice.force[1], WithinAbs(-1.6, kExact));
  CHECK_THAT(choice.acceleration[0], WithinAbs(12.0, kExact));
}

TEST_CASE("A contact whose force has reached its limit lets go, and takes along what it held") {
  // Two contacts in line on one mass and the next: the second falls from 2 to 1 and the first holds the rest.
  MatrixXd G(2, 2);
  G << 1.0, -1.0, -1.0, 2.0;
  ContactsAtRest rest =
      at_rest(G, G * Eigen::Vector2d(0.5, 2.0), Eigen::Vector2d(0.4, 1.0), Eigen::Vector2d(1.0, 2.0));
  rest.stuck_before = bit(0) | bit(1);
  const BrokenClaims grows = [](const RestChoice& choice) { return choice.on_edge; };
  const BrokenClaims falls = [](const RestChoice&) { return ContactMask{0}; };
  CHECK(admissible_choice(rest, falls).stuck == (bit(0) | bit(1)));
  const RestChoice without_event = admissible_choice(rest, grows);
  rest.letting_go = bit(1);
  const RestChoice choice = admissible_choice(rest, falls);
  REQUIRE(choice.found);
  CHECK(choice.stuck == without_event.stuck);
  CHECK(choice.stuck == bit(0));
  CHECK(choice.forward == bit(1));
  // a_0 = 0: lambda_0 = c_0 + lambda_1 = -1.5 + 1
  CHECK_THAT(choice.force[0], WithinAbs(-0.5, kExact));
}

TEST_CASE("In a loop of contacts the others hold what is beyond the share of one") {
  // Two parallel contacts on one mass of 1 kg under 2.5 N, which hold 1 N and 2 N, and slide with half.
  const MatrixXd G = MatrixXd::Ones(2, 2);
  ContactsAtRest rest =
      at_rest(G, Eigen::Vector2d::Constant(2.5), Eigen::Vector2d(0.5, 1.0), Eigen::Vector2d(1.0, 2.0));
  rest.has_loops = true;
  RestChoice choice = admissible_choice(rest, kNoneBroken);
  REQUIRE(choice.found);
  CHECK(choice.stuck == (bit(0) | bit(1)));
  CHECK_THAT(choice.force.sum(), WithinAbs(2.5, kExact));
  rest.free.setConstant(3.5);  // more than 3 N: both slide
  const BrokenClaims zero_does_not_slide = [](const RestChoice& of) { return of.on_edge & ~of.stuck; };
  choice = admissible_choice(rest, zero_does_not_slide);
  REQUIRE(choice.found);
  CHECK(choice.stuck == 0);
  CHECK(choice.forward == (bit(0) | bit(1)));
  CHECK_THAT(choice.acceleration[0], WithinAbs(2.0, kExact));
}

TEST_CASE("Of many contacts an admissible choice is found by changing what breaks its claim") {
  // A chain of 20: each between one mass and the next, the first on the ground.
  constexpr Index kContacts = 20;
  MatrixXd W = MatrixXd::Identity(kContacts, kContacts);
  for (Index i = 1; i < kContacts; ++i) W(i - 1, i) = -1.0;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 100; ++trial) {
    const VectorXd force = VectorXd::NullaryExpr(kContacts, [&] { return normal(random); });
    const ContactsAtRest rest =
        at_rest(W.transpose() * W, W.transpose() * force, VectorXd::Constant(kContacts, 1.0),
                VectorXd::Constant(kContacts, 1.8));
    const RestChoice choice = admissible_choice(rest, kNoneBroken);
    INFO("trial " << trial);
    REQUIRE(choice.found);
    for (Index i = 0; i < kContacts; ++i) {
      if (contains(choice.stuck, i)) {
        CHECK(std::abs(choice.force[i]) <= rest.limit[i]);
        CHECK_THAT(choice.acceleration[i], WithinAbs(0.0, 1e2 * kExact));
      } else {
        CHECK((contains(choice.forward, i) ? 1.0 : -1.0) * choice.acceleration[i] > 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::admissible_test
