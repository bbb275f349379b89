#include "solvers/identification/least_squares.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "solvers/identification/identification.hpp"

namespace least_squares_test {
namespace {

using namespace frahm::identification;

constexpr double kRounding = 1e-11;

// NIST StRD "Misra1a": y = b1 (1 - exp(-b2 x)), certified to ten digits.
// Source: National Institute of Standards and Technology, Statistical Reference Datasets, nonlinear
// regression.
const std::vector<double> misra_x{77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
                                  378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};
const std::vector<double> misra_y{10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
                                  44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};

bool misra(const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
  const auto size = static_cast<Eigen::Index>(misra_x.size());
  r.resize(size);
  if (jacobian) jacobian->resize(size, 2);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double x = misra_x[static_cast<std::size_t>(i)], e = std::exp(-p[1] * x);
    r[i] = p[0] * (1.0 - e) - misra_y[static_cast<std::size_t>(i)];
    if (jacobian) jacobian->row(i) << 1.0 - e, p[0] * x * e;
  }
  return true;
}

TEST_CASE("NIST's Misra1a comes out with its certified values and standard deviations, from both starts") {
  constexpr double kCertified = 1e-9;  // ten digits are printed
  for (const auto& [b1, b2] : {std::pair{500.0, 0.0001}, std::pair{250.0, 0.0005}}) {
    for (const bool bounded : {false, true}) {
      std::vector<Unknown> unknowns{{.name = "b1", .start = b1, .scale = 100.0},
                                    {.name = "b2", .start = b2, .scale = 1e-4}};
      if (bounded) unknowns[0].lower = unknowns[1].lower = 0.0;
      if (bounded) unknowns[1].upper = 0.01;
      const LeastSquaresFit fit = least_squares(unknowns, misra);
      INFO(fit.reason);
      CHECK(fit.converged);
      CHECK_THAT(fit.p[0], Catch::WithinRel(2.3894212918e+02, kCertified));
      CHECK_THAT(fit.p[1], Catch::WithinRel(5.5015643181e-04, kCertified));
      CHECK_THAT(fit.sum_of_squares(), Catch::WithinRel(1.2455138894e-01, kCertified));
      const Eigen::MatrixXd cov =
          covariance(fit.jacobian, fit.sum_of_squares() / 12.0, Eigen::Vector2d(100.0, 1e-4));
      CHECK_THAT(std::sqrt(cov(0, 0)), Catch::WithinRel(2.7070075241e+00, 1e-7));
      CHECK_THAT(std::sqrt(cov(1, 1)), Catch::WithinRel(7.2668688436e-06, 1e-7));
    }
  }
}

TEST_CASE("a minimum outside the bounds ends at the bound, and the rest is fitted there") {
  // r = (x - 3, y - 2 x): within x <= 1 least at x = 1, y = 2.
  const Residuals residuals = [](const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
    r = Eigen::Vector2d(p[0] - 3.0, p[1] - 2.0 * p[0]);
    if (jacobian) *jacobian = (Eigen::Matrix2d() << 1.0, 0.0, -2.0, 1.0).finished();
    return true;
  };
  for (const double lower : {0.0, -std::numeric_limits<double>::infinity()}) {
    const LeastSquaresFit fit =
        least_squares({{.name = "x", .start = 0.5, .lower = lower, .upper = 1.0}, {.name = "y"}}, residuals);
    CHECK(fit.converged);
    CHECK(fit.p[0] == 1.0);
    CHECK_THAT(fit.p[1], Catch::WithinAbs(2.0, kRounding));
    CHECK(fit.at_bound == std::vector<int>{1, 0});
  }
}

TEST_CASE("a start that stands on a bound leaves it") {
  const Residuals residuals = [](const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
    r = p - Eigen::VectorXd::Constant(1, 0.25);
    if (jacobian) *jacobian = Eigen::MatrixXd::Identity(1, 1);
    return true;
  };
  for (const double upper : {1.0, std::numeric_limits<double>::infinity()}) {
    const LeastSquaresFit fit =
        least_squares({{.name = "x", .start = 0.0, .lower = 0.0, .upper = upper}}, residuals);
    CHECK(fit.converged);
    CHECK_THAT(fit.p[0], Catch::WithinAbs(0.25, kRounding));
  }
}

TEST_CASE("where the model has no value a shorter step is taken") {
  // ln x = 2 from x = 0.1: full steps lead below zero.
  const Residuals residuals = [](const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
    if (p[0] <= 0.0) return false;
    r = Eigen::VectorXd::Constant(1, std::log(p[0]) - 2.0);
    if (jacobian) *jacobian = Eigen::MatrixXd::Constant(1, 1, 1.0 / p[0]);
    return true;
  };
  const LeastSquaresFit fit = least_squares({{.name = "x", .start = 60.0}}, residuals);
  CHECK(fit.converged);
  CHECK_THAT(fit.p[0], Catch::WithinRel(std::exp(2.0), kRounding));
}

TEST_CASE("two unknowns that do the same are not determined, a third is") {
  // y = (a + b) x + c: rows of the Jacobian (x, x, 1).
  Eigen::MatrixXd jacobian(4, 3);
  jacobian << 1, 1, 1, 2, 2, 1, 3, 3, 1, 4, 4, 1;
  const Eigen::MatrixXd cov = covariance(jacobian, 1.0, Eigen::Vector3d(1.0, 1.0, 1.0));
  CHECK(std::isinf(cov(0, 0)));
  CHECK(std::isinf(cov(1, 1)));
  CHECK(std::isnan(cov(0, 2)));
  // Of the line y = s x + c: var c = sum x^2 / (n sum (x - mean x)^2) = 30 / 20.
  CHECK_THAT(cov(2, 2), Catch::WithinRel(1.5, kRounding));
  jacobian.col(1).setZero();
  const Eigen::MatrixXd without = covariance(jacobian, 1.0, Eigen::Vector3d(1.0, 1.0, 1.0));
  CHECK(std::isinf(without(1, 1)));
  CHECK_THAT(without(0, 0), Catch::WithinRel(1.0 / 5.0, kRounding));
}

// As a model solved to a tolerance of its own: a line through scattered values, rough in its seventh digit.
bool rough_line(const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) {
  constexpr Eigen::Index kSize = 50;
  r.resize(kSize);
  if (jacobian) jacobian->resize(kSize, 2);
  for (Eigen::Index i = 0; i < kSize; ++i) {
    const double x = static_cast<double>(i) / 50.0, scatter = i % 2 == 0 ? 0.01 : -0.01;
    const double rough = 1e-7 * std::sin(1e11 * (p[0] + p[1]) + 7.0 * static_cast<double>(i));
    r[i] = p[0] + p[1] * x - (1.0 + 2.0 * x + scatter) + rough;
    if (jacobian) jacobian->row(i) << 1.0, x;
  }
  return true;
}

// Eight evaluations are no end of it by the tolerance, though the line is met after three.
TEST_CASE("a rough sum of squares has been minimised where no step matters any more") {
  const LeastSquaresFit fit = least_squares({{.name = "a", .start = 5.0}, {.name = "b", .start = 0.1}},
                                            rough_line, {.tolerance = 1e-15, .most_evaluations = 8});
  CHECK(fit.converged);
  // Within a standard error of the truth: 2 s / sqrt(N) of a line's intercept, sqrt(12 / N) s of its slope.
  CHECK(std::abs(fit.p[0] - 1.0) < 0.01 * 2.0 / std::sqrt(50.0));
  CHECK(std::abs(fit.p[1] - 2.0) < 0.01 * std::sqrt(12.0 / 50.0));
}

Estimate estimate(const char* name, double value) {
  return {.name = name, .unit = "1", .long_name = "", .value = value};
}

TEST_CASE("a model without a derivative where the search stands is no fit") {
  const Residuals no_derivative = [](const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* by) {
    r = Eigen::Vector3d(p[0] - 1.0, p[0] - 2.0, p[0] - 3.0);
    if (by != nullptr) by->setZero(3, 1);
    return by == nullptr;
  };
  const LeastSquaresFit fit = least_squares({{.name = "p", .start = 1.5}}, no_derivative, {});
  CHECK_FALSE(fit.converged);
  CHECK(fit.jacobian.size() == 0);
  CHECK_THAT(fit.reason, Catch::Matchers::Contains("no derivative"));
}

TEST_CASE("intervals reach as far as Student's t, and what is derived has its share") {
  Identification result;
  result.estimates = {estimate("a", 2.0), estimate("b", 3.0)};
  result.covariance = (Eigen::Matrix2d() << 0.04, 0.01, 0.01, 0.09).finished();
  result.degrees_of_freedom = 10.0;
  add_derived(result, estimate("product", 6.0), Eigen::Vector2d(3.0, 2.0));
  set_intervals(result);
  constexpr double kTable = 2.2281388520;  // t of 10 degrees of freedom at 97.5 %, from any table
  CHECK_THAT(result.estimates[0].high, Catch::WithinRel(2.0 + kTable * 0.2, 1e-9));
  CHECK_THAT(result.estimates[1].low, Catch::WithinRel(3.0 - kTable * 0.3, 1e-9));
  // var(ab) = b^2 var a + a^2 var b + 2 a b cov = 0.36 + 0.36 + 0.12
  CHECK_THAT(result.estimates[2].standard_error, Catch::WithinRel(std::sqrt(0.84), kRounding));
  CHECK_THAT(correlation(result.covariance)(0, 1), Catch::WithinRel(0.01 / 0.06, kRounding));
}

TEST_CASE("the fit quality is 100 where all is met and 0 where a constant does as well") {
  CHECK(nrmse(std::vector<FittedSeries>{{"x", "m", {1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}}}) == 100.0);
  CHECK_THAT(nrmse(std::vector<FittedSeries>{{"x", "m", {1.0, 2.0, 3.0}, {2.0, 2.0, 2.0}}}),
             Catch::WithinAbs(0.0, kRounding));
  CHECK(std::isnan(nrmse(std::vector<FittedSeries>{{"x", "m", {1.0, 1.0}, {1.0, 1.0}}})));
}

}  // namespace
}  // namespace least_squares_test
