#include "solvers/orbits/contact_cuts.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solvers/events/box_minimum.hpp"

namespace frahm::periodic::contact_cuts_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
constexpr double kRounding = 1e-12;  // of entries of order 1

bool holds(const std::vector<VectorXd>& cuts, const VectorXd& cut) {
  return std::ranges::any_of(
      cuts, [&](const VectorXd& c) { return (c - cut).norm() < kRounding || (c + cut).norm() < kRounding; });
}

TEST_CASE("A ring of contacts is cut in pairs, a contact beside it by itself") {
  // ground - 1, 1 - 2, 2 - ground, and 3 - ground
  MatrixXd W(3, 4);
  W << 1, -1, 0, 0,  //
      0, 1, 1, 0,    //
      0, 0, 0, 1;
  const auto cuts = contact_cuts(W);
  REQUIRE(cuts);
  REQUIRE(cuts->size() == 4);
  CHECK(holds(*cuts, Eigen::Vector4d(0, 0, 0, 1)));
  CHECK(holds(*cuts, Eigen::Vector4d(1, -1, 0, 0)));  // around mass 1
  CHECK(holds(*cuts, Eigen::Vector4d(0, 1, 1, 0)));   // around mass 2
  CHECK(holds(*cuts, Eigen::Vector4d(1, 0, 1, 0)));   // around both
}

TEST_CASE("Contacts side by side have one cut, and one without a direction none") {
  const auto cuts = contact_cuts(Eigen::RowVector3d(1.0, -0.5, 0.0));
  REQUIRE(cuts);
  REQUIRE(cuts->size() == 1);
  CHECK(holds(*cuts, Eigen::Vector3d(1.0, -0.5, 0.0)));
}

TEST_CASE("Too many cuts are not told") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  CHECK_FALSE(contact_cuts(MatrixXd::NullaryExpr(10, 24, [&] { return normal(random); })));
}

// The distance of a load from all that contacts can carry within their limits, found without cuts.
double out_of_reach(const MatrixXd& W, const VectorXd& load, const VectorXd& limit) {
  const BoxMinimum nearest = box_minimum(W.transpose() * W, W.transpose() * load, -limit, limit, limit);
  REQUIRE(nearest.found);
  return (W * nearest.lambda - load).norm();
}

TEST_CASE("Contacts carry a load exactly where no cut carries more than its limit") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.1, 1.0);
  for (int trial = 0; trial < 300; ++trial) {
    INFO("trial " << trial);
    const Index m = 2 + trial % 5, rank = std::max<Index>(1, m - 1 - trial % 3);
    const MatrixXd W = MatrixXd::NullaryExpr(rank + trial % 2, rank, [&] { return normal(random); }) *
                       MatrixXd::NullaryExpr(rank, m, [&] { return normal(random); });
    const VectorXd limit = VectorXd::NullaryExpr(m, [&] { return uniform(random); });
    const VectorXd shares = VectorXd::NullaryExpr(m, [&] { return normal(random); });
    const auto cuts = contact_cuts(W);
    REQUIRE(cuts);
    double most = HUGE_VAL;  // of the load W shares
    for (const VectorXd& c : *cuts) most = std::min(most, c.cwiseAbs().dot(limit) / std::abs(c.dot(shares)));
    const VectorXd load = W * shares * most;
    CHECK(out_of_reach(W, load * (1.0 - 1e-6), limit) < 1e-10 * load.norm());
    CHECK(out_of_reach(W, load * (1.0 + 1e-4), limit) > 1e-10 * load.norm());
  }
}

}  // namespace
}  // namespace frahm::periodic::contact_cuts_test
