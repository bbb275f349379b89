#include "solvers/samples/scatter.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/samples/correlated.hpp"
#include "solvers/samples/distribution.hpp"
#include "solvers/samples/sequence.hpp"

namespace scatter_test {
namespace {

using namespace frahm::samples;

// P(B = k) of a binomial B, from logarithms of factorials.
double binomial(std::size_t n, std::size_t k, double p) {
  const auto x = static_cast<double>(n), y = static_cast<double>(k);
  return std::exp(std::lgamma(x + 1) - std::lgamma(y + 1) - std::lgamma(x - y + 1) + y * std::log(p) +
                  (x - y) * std::log1p(-p));
}

// The probability that low <= B < high.
double coverage(std::size_t n, double p, Ranks ranks) {
  double sum = 0.0;
  for (std::size_t k = ranks.low; k < ranks.high; ++k) sum += binomial(n, k, p);
  return sum;
}

TEST_CASE("the interval of a quantile holds it with 95 % at least, and neither end can come nearer") {
  for (const std::size_t n : {2U, 10U, 59U, 100U, 1000U}) {
    for (const double p : {0.01, 0.05, 0.5, 0.9, 0.95}) {
      INFO(n << " samples, share " << p);
      const Ranks ranks = ranks_about(p, n);
      CHECK(coverage(n, p, ranks) >= 0.95 - 1e-12);
      CHECK(coverage(n, p, {0, ranks.low + 1}) > 0.025);
      CHECK(coverage(n, p, {ranks.high - 1, n + 1}) > 0.025);
    }
  }
}

TEST_CASE("too few samples leave an interval open") {
  // None of n samples lies below with probability 0.95^n: 0.0262 of 71, 0.0249 of 72.
  CHECK(ranks_about(0.05, 71).low == 0);
  CHECK(ranks_about(0.05, 72).low == 1);
  std::vector<double> few{3.0, 1.0, 2.0};
  const Scatter scatter = ScatterOf({0.05, 0.95})(few);
  CHECK(scatter.quantiles[0].low == -frahm::kInfinity);
  CHECK(scatter.quantiles[1].high == frahm::kInfinity);
}

TEST_CASE("mean, deviation and quantiles of five numbers are those of the textbook") {
  std::vector<double> values{4.0, 1.0, frahm::kNone, 3.0, 5.0, 2.0};
  const Scatter scatter = ScatterOf({0.1, 0.5})(values);
  CHECK(scatter.samples == 5);
  CHECK_THAT(scatter.mean.value, Catch::WithinRel(3.0, 1e-15));
  CHECK_THAT(scatter.deviation, Catch::WithinRel(std::sqrt(2.5), 1e-15));
  // Student's t of four degrees of freedom at 97.5 %: 2.7764451.
  CHECK_THAT(scatter.mean.high - 3.0, Catch::WithinRel(2.7764451 * std::sqrt(0.5), 1e-7));
  CHECK_THAT(3.0 - scatter.mean.low, Catch::WithinRel(2.7764451 * std::sqrt(0.5), 1e-7));
  // numpy.quantile([1, 2, 3, 4, 5], [0.1, 0.5]) is [1.4, 3].
  CHECK_THAT(scatter.quantiles[0].value, Catch::WithinRel(1.4, 1e-15));
  CHECK_THAT(scatter.quantiles[1].value, Catch::WithinRel(3.0, 1e-15));
}

TEST_CASE("without a value there is no estimate, with one no interval") {
  std::vector<double> none{frahm::kNone, frahm::kNone}, one{2.0, frahm::kNone};
  ScatterOf scatter_of({0.5});
  const Scatter without = scatter_of(none), single = scatter_of(one);
  CHECK(without.samples == 0);
  CHECK(std::isnan(without.mean.value));
  CHECK(std::isnan(without.quantiles[0].value));
  CHECK(single.mean.value == 2.0);
  CHECK(std::isnan(single.mean.low));
  CHECK(std::isnan(single.deviation));
  CHECK(single.quantiles[0].value == 2.0);
}

TEST_CASE("correlated normals have the mean and the covariance that they are made from") {
  const Eigen::Vector3d mean(5.0, -2.0, 1e-6);
  Eigen::Matrix3d factor;
  factor << 2.0, 0.0, 0.0, 1.0, 0.5, 0.0, 1e-7, -2e-7, 1e-7;
  const Eigen::Matrix3d wanted = factor * factor.transpose();
  const auto normals = correlated_normals(mean, wanted, unit_points(Sequence::sobol, 1 << 14, 3, 1));
  REQUIRE(normals);
  const Eigen::MatrixXd found = covariance(*normals);
  for (int i = 0; i < 3; ++i) {
    const double deviation = std::sqrt(wanted(i, i));
    CHECK_THAT(means(*normals)(i), Catch::WithinAbs(mean(i), 1e-3 * deviation));
    for (int j = 0; j < 3; ++j)
      CHECK_THAT(found(i, j), Catch::WithinAbs(wanted(i, j), 2e-3 * deviation * std::sqrt(wanted(j, j))));
  }
}

TEST_CASE("numbers that move as one, or do not move, are drawn too; an impossible covariance is refused") {
  const Eigen::MatrixXd points = unit_points(Sequence::random, 50, 2, 1);
  Eigen::Matrix2d covariance_of;
  covariance_of << 4.0, 2.0, 2.0, 1.0;  // of correlation 1
  const auto as_one = correlated_normals(Eigen::Vector2d(0.0, 0.0), covariance_of, points);
  REQUIRE(as_one);
  CHECK(as_one->col(0).isApprox(2.0 * as_one->col(1), 1e-7));

  covariance_of << 0.0, 0.0, 0.0, 1.0;
  const auto one_still = correlated_normals(Eigen::Vector2d(3.0, 0.0), covariance_of, points);
  REQUIRE(one_still);
  CHECK((one_still->col(0).array() == 3.0).all());

  covariance_of << 1.0, 2.0, 2.0, 1.0;
  CHECK_FALSE(correlated_normals(Eigen::Vector2d(0.0, 0.0), covariance_of, points));
  covariance_of << 1.0, frahm::kNone, frahm::kNone, 1.0;
  CHECK_FALSE(correlated_normals(Eigen::Vector2d(0.0, 0.0), covariance_of, points));
}

}  // namespace
}  // namespace scatter_test
