#include "solvers/samples/distribution.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

namespace distribution_test {
namespace {

using frahm::kInfinity;
using namespace frahm::samples;
using Kind = Distribution::Kind;

constexpr double closed_form = 1e-12;  // of a quantile
constexpr double integrated = 1e-5;    // of a moment, by a sum over a million shares

struct Moments {
  double mean, deviation;
};

// By the middles of equal shares: E x = integral of the quantile over the shares.
Moments moments_of(const Distribution& distribution) {
  constexpr int parts = 1'000'000;
  double sum = 0.0, squares = 0.0;
  const double about = quantile(distribution, 0.5);
  for (int i = 0; i < parts; ++i) {
    const double x = quantile(distribution, (i + 0.5) / parts) - about;
    sum += x;
    squares += x * x;
  }
  const double mean = sum / parts;
  return {about + mean, std::sqrt(squares / parts - mean * mean)};
}

void check_moments(const Distribution& distribution, Moments expected) {
  const Moments found = moments_of(distribution);
  CHECK_THAT(found.mean, Catch::WithinRel(expected.mean, integrated));
  CHECK_THAT(found.deviation, Catch::WithinRel(expected.deviation, 10 * integrated));
}

double density(double x) {
  return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
}
double below(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

TEST_CASE("a normal number lies below mean + 1.96 deviations in 97.5 of 100 cases") {
  const Distribution normal{.kind = Kind::normal, .centre = 5.0, .spread = 2.0};
  CHECK_THAT(quantile(normal, 0.975), Catch::WithinRel(5.0 + 2.0 * 1.959963984540054, closed_form));
  CHECK_THAT(quantile(normal, 0.5), Catch::WithinRel(5.0, closed_form));
  check_moments(normal, {5.0, 2.0});
}

TEST_CASE("a cut normal distribution has the moments of the closed form, in its middle and in its tails") {
  for (const auto& [lower, upper] : {std::pair(-1.0, 0.5), {1.0, kInfinity}, {4.0, 4.5}, {-4.5, -4.0}}) {
    INFO("from " << lower << " to " << upper << " deviations");
    const Distribution cut{.centre = 10.0, .spread = 2.0, .lower = 10 + 2 * lower, .upper = 10 + 2 * upper};
    // From the side of the smaller shares, so that the reference keeps its digits.
    const double share = lower > 0.0 ? below(-lower) - below(-upper) : below(upper) - below(lower);
    CHECK_THAT(kept_share(cut), Catch::WithinRel(share, 1e-9));
    const double edge_low = lower * density(lower),
                 edge_high = std::isinf(upper) ? 0.0 : upper * density(upper);
    const double a = (density(lower) - density(upper)) / share;
    const double variance = 1.0 + (edge_low - edge_high) / share - a * a;
    check_moments(cut, {10.0 + 2.0 * a, 2.0 * std::sqrt(variance)});
    CHECK(quantile(cut, 1e-15) >= cut.lower);
    CHECK(quantile(cut, 1.0 - 1e-15) <= cut.upper);
  }
}

TEST_CASE("a lognormal distribution has the mean, median and deviation that it is made from") {
  const double by_variation = log_deviation(0.3);
  const Distribution of_mean{.kind = Kind::lognormal,
                             .centre = 7.0 * std::exp(-0.5 * by_variation * by_variation),
                             .spread = by_variation};
  check_moments(of_mean, {7.0, 2.1});

  const Distribution of_median{
      .kind = Kind::lognormal, .centre = 7.0, .spread = log_deviation_by_median(2.0 / 7.0)};
  CHECK_THAT(quantile(of_median, 0.5), Catch::WithinRel(7.0, closed_form));
  CHECK_THAT(moments_of(of_median).deviation, Catch::WithinRel(2.0, 10 * integrated));
}

TEST_CASE("the cuts of a lognormal number are its smallest and largest values") {
  const Distribution cut{.kind = Kind::lognormal, .centre = 1.0, .spread = 0.5, .lower = 0.5, .upper = 2.0};
  CHECK_THAT(quantile(cut, 1e-12), Catch::WithinRel(0.5, 1e-9));
  CHECK_THAT(quantile(cut, 1.0 - 1e-12), Catch::WithinRel(2.0, 1e-9));
  // Symmetric in the logarithm.
  CHECK_THAT(quantile(cut, 0.3) * quantile(cut, 0.7), Catch::WithinRel(1.0, closed_form));
  CHECK_THAT(quantile({.kind = Kind::lognormal, .centre = 1.0, .lower = -3.0}, 0.5),
             Catch::WithinRel(1.0, closed_form));
}

TEST_CASE("uniform and triangular numbers have the moments of their closed forms") {
  check_moments({.kind = Kind::uniform, .lower = 1.0, .upper = 4.0}, {2.5, 3.0 / std::sqrt(12.0)});
  const double a = 1.0, c = 2.0, b = 6.0;
  const double variance = (a * a + b * b + c * c - a * b - a * c - b * c) / 18.0;
  const Distribution triangular{.kind = Kind::triangular, .centre = c, .lower = a, .upper = b};
  check_moments(triangular, {(a + b + c) / 3.0, std::sqrt(variance)});
  // The part below the mode is (c - a)/(b - a).
  CHECK_THAT(quantile(triangular, (c - a) / (b - a)), Catch::WithinRel(c, closed_form));
}

}  // namespace
}  // namespace distribution_test
