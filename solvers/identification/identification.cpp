#include "solvers/identification/identification.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "solvers/algebra/no_value.hpp"

namespace frahm::identification {
namespace {

// How many standard errors the interval reaches either way.
double reach(double degrees_of_freedom) {
  if (!(degrees_of_freedom > 0.0)) return kNone;
  const boost::math::students_t t(degrees_of_freedom);
  return boost::math::quantile(t, 0.5 * (1.0 + kConfidence));
}

}  // namespace

double nrmse(std::span<const FittedSeries> series) {
  double missed = 0.0, varies = 0.0;
  for (const FittedSeries& each : series) {
    const auto size = static_cast<Eigen::Index>(each.measured.size());
    const Eigen::Map<const Eigen::VectorXd> y(each.measured.data(), size), fit(each.fitted.data(), size);
    const double spread = (y.array() - y.mean()).matrix().squaredNorm();
    // Series of different sensors count by the share of their own variation that is missed.
    if (!(spread > kConstant * kConstant * y.squaredNorm())) continue;
    missed += (y - fit).squaredNorm() / spread;
    varies += 1.0;
  }
  // 100 (1 - |y - yhat| / |y - mean y|)
  return varies > 0.0 ? 100.0 * (1.0 - std::sqrt(missed / varies)) : kNone;
}

Eigen::MatrixXd correlation(const Eigen::MatrixXd& covariance) {
  const Eigen::Index n = covariance.rows();
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
      result(i, j) = i == j && std::isfinite(scale) ? 1.0 : covariance(i, j) / scale;
      if (std::isinf(scale)) result(i, j) = kNone;
    }
  }
  return result;
}

void set_intervals(Identification& result) {
  for (std::size_t i = 0; i < result.estimates.size(); ++i) {
    Estimate& estimate = result.estimates[i];
    const auto place = static_cast<Eigen::Index>(i);
    if (std::isnan(estimate.degrees_of_freedom)) estimate.degrees_of_freedom = result.degrees_of_freedom;
    const double errors = reach(estimate.degrees_of_freedom);
    estimate.standard_error = std::sqrt(result.covariance(place, place));
    if (std::isinf(estimate.standard_error)) {
      estimate.value = kNone;
      estimate.low = -kInfinity;
      estimate.high = kInfinity;
      continue;
    }
    estimate.low = estimate.value - errors * estimate.standard_error;
    estimate.high = estimate.value + errors * estimate.standard_error;
  }
}

// cov(g(p), p) = g'^T cov,  var g(p) = g'^T cov g'
void add_derived(Identification& result, Estimate estimate, const Eigen::VectorXd& gradient) {
  const Eigen::Index n = result.covariance.rows();
  Eigen::VectorXd beside = Eigen::VectorXd::Zero(n);
  bool determined = true;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (gradient[i] == 0.0) continue;
    determined = determined && !std::isinf(result.covariance(i, i));
    beside += gradient[i] * result.covariance.col(i);
  }
  double variance = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (gradient[i] != 0.0) variance += gradient[i] * beside[i];
  }
  result.covariance.conservativeResize(n + 1, n + 1);
  result.covariance.topRightCorner(n, 1) = determined ? beside : Eigen::VectorXd::Constant(n, kNone);
  result.covariance.bottomLeftCorner(1, n) = result.covariance.topRightCorner(n, 1).transpose();
  result.covariance(n, n) = determined ? variance : kInfinity;
  result.estimates.push_back(std::move(estimate));
}

}  // namespace frahm::identification
