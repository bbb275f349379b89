#include "solvers/events/box_minimum.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

namespace frahm::periodic::box_minimum_test {
namespace {

using Catch::Matchers::WithinAbs;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
constexpr double kOptimality = 1e-10;  // of the slope, relative to |c|

// Karush-Kuhn-Tucker: the slope G lambda - c is zero inside, points inwards at neither bound.
void check_minimum(const MatrixXd& G, const VectorXd& c, const VectorXd& limit) {
  const VectorXd lambda = box_minimum(G, c, -limit, limit, limit).lambda;
  const VectorXd slope = G * lambda - c;
  const double scale = c.cwiseAbs().maxCoeff() + G.cwiseAbs().maxCoeff() * limit.maxCoeff();
  for (Index j = 0; j < c.size(); ++j) {
    INFO("component " << j << " of " << c.size());
    CHECK(std::abs(lambda[j]) <= limit[j]);
    if (lambda[j] < limit[j]) CHECK(slope[j] > -kOptimality * scale);
    if (lambda[j] > -limit[j]) CHECK(slope[j] < kOptimality * scale);
  }
}

TEST_CASE("The minimum over a box satisfies its optimality conditions, for definite and singular matrices") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.1, 2.0);
  for (int trial = 0; trial < 3000; ++trial) {
    const Index m = 1 + trial % 5, rank = trial % 3 == 0 ? std::max<Index>(1, m - 1) : m;
    const MatrixXd root = MatrixXd::NullaryExpr(rank, m, [&] { return normal(random); });
    const VectorXd limit = VectorXd::NullaryExpr(m, [&] { return uniform(random); });
    // Forces of friction contacts: c = W^T a lies in the range of G, or not quite where supports move.
    VectorXd c = root.transpose() * VectorXd::NullaryExpr(rank, [&] { return 3.0 * normal(random); });
    if (trial % 7 == 0) c[0] += normal(random);
    check_minimum(root.transpose() * root, c, limit);
  }
}

TEST_CASE("Of forces that serve equally those of least sum (lambda / F)^2 are taken") {
  const MatrixXd G = MatrixXd::Ones(2, 2);
  const VectorXd limit = Eigen::Vector2d(3.0, 1.0), c = Eigen::Vector2d(2.0, 2.0);
  const VectorXd lambda = box_minimum(G, c, -limit, limit, limit).lambda;
  // lambda_1 + lambda_2 = 2 and lambda_1 / 9 = lambda_2
  CHECK_THAT(lambda[0], WithinAbs(1.8, 1e-14));
  CHECK_THAT(lambda[1], WithinAbs(0.2, 1e-14));
}

TEST_CASE("A limit of any size beside small ones leaves the small ones their digits") {
  MatrixXd G(2, 2);
  G << 1.0, -1.0, -1.0, 3.0;
  const VectorXd c = Eigen::Vector2d(0.3, 0.4);
  // inside both limits: lambda = G^-1 c = (0.65, 0.35)
  for (const double large : {1.0, 1e4, 1e7, 1e12}) {
    INFO("large limit " << large);
    const VectorXd limit = Eigen::Vector2d(large, 1.0);
    const VectorXd lambda = box_minimum(G, c, -limit, limit, limit).lambda;
    CHECK_THAT(lambda[0], WithinAbs(0.65, 1e-15));
    CHECK_THAT(lambda[1], WithinAbs(0.35, 1e-15));
  }
}

TEST_CASE("Beyond all limits together every contact stands at its own") {
  const MatrixXd G = MatrixXd::Ones(3, 3);
  const VectorXd limit = Eigen::Vector3d(1.0, 2.0, 0.5), c = Eigen::Vector3d::Constant(-9.0);
  CHECK(box_minimum(G, c, -limit, limit, limit).lambda == -limit);
}

}  // namespace
}  // namespace frahm::periodic::box_minimum_test
