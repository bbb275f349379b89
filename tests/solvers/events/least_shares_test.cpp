#include "solvers/events/least_shares.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solvers/algebra/null_space.hpp"

namespace frahm::periodic::least_shares_test {
namespace {

using Catch::Matchers::WithinAbs;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
constexpr double kRounding = 1e-11;  // of forces of order 1

TEST_CASE("Contacts side by side share by the squares of their limits, up to these") {
  const MatrixXd W = MatrixXd::Ones(1, 2);
  const VectorXd limit = Eigen::Vector2d(1.0, 3.0);
  for (const double force : {-3.9, -2.0, 0.0, 2.0, 3.9}) {
    INFO("together " << force);
    const double first = std::clamp(force, -1.0, 1.0);
    const LeastShares shares = least_shares(W, Eigen::Vector2d(first, force - first), limit, limit);
    const double second = std::clamp(0.9 * force, -3.0, 3.0);
    CHECK_THAT(shares.lambda[1], WithinAbs(second, kRounding));
    CHECK_THAT(shares.lambda[0], WithinAbs(force - second, kRounding));
    CHECK(shares.bound.empty() == (std::abs(force) < 3.0));
  }
}

// A random place on the way from lambda along a direction to the first bound.
VectorXd moved(const VectorXd& lambda, const VectorXd& direction, const VectorXd& bound, double share) {
  double room = HUGE_VAL;
  for (Index j = 0; j < lambda.size(); ++j) {
    const double ahead = bound[j] - (direction[j] > 0.0 ? lambda[j] : -lambda[j]);
    if (std::abs(direction[j]) > 1e-9) room = std::min(room, ahead / std::abs(direction[j]));
  }
  return lambda + share * std::max(0.0, room) * direction;
}

TEST_CASE("The shares of contacts in loops are the least from wherever they are sought") {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int bounded = 0;
  for (int trial = 0; trial < 500; ++trial) {
    INFO("trial " << trial);
    const Index m = 2 + trial % 5, rank = std::max<Index>(1, m - 1 - trial % 3);
    const MatrixXd W = MatrixXd::NullaryExpr(rank + trial % 2, rank, [&] { return normal(random); }) *
                       MatrixXd::NullaryExpr(rank, m, [&] { return normal(random); });
    const VectorXd bound =
        VectorXd::NullaryExpr(m, [&] { return std::pow(10.0, 2.0 * uniform(random) - 1.0); });
    // Half of them at a bound, so that many loads hardly fit.
    const VectorXd start = VectorXd::NullaryExpr(m, [&] {
                             return std::clamp(4.0 * uniform(random) - 2.0, -1.0, 1.0);
                           }).cwiseProduct(bound);
    const LeastShares shares = least_shares(W, start, bound, bound);
    const VectorXd& lambda = shares.lambda;
    bounded += static_cast<int>(shares.bound.size());
    CHECK((W * (lambda - start)).norm() <= kRounding * W.norm() * bound.norm());
    CHECK((lambda.cwiseAbs().array() <= bound.array() * (1.0 + kRounding)).all());
    for (const Index j : shares.bound) CHECK(std::abs(lambda[j]) == bound[j]);

    const MatrixXd loops = algebra::null_space(W);
    for (int other = 0; other < 20 && loops.cols() > 0; ++other) {
      const VectorXd direction = loops * VectorXd::NullaryExpr(loops.cols(), [&] { return normal(random); });
      const VectorXd elsewhere = moved(lambda, direction, bound, uniform(random));
      const double least = lambda.cwiseQuotient(bound).squaredNorm();
      CHECK(elsewhere.cwiseQuotient(bound).squaredNorm() >= least * (1.0 - kRounding));
      const VectorXd again = least_shares(W, elsewhere, bound, bound).lambda;
      CHECK((again - lambda).cwiseQuotient(bound).norm() <= 1e-9);
    }
  }
  CHECK(bounded > 200);
}

}  // namespace
}  // namespace frahm::periodic::least_shares_test
