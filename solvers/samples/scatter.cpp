#include "solvers/samples/scatter.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "solvers/algebra/no_value.hpp"

namespace frahm::samples {
namespace {

constexpr double kOutside = 0.5 * (1.0 - kConfidence);  // on each side

// The least k from 0 to n with P(B <= k) > kOutside, B binomial.
std::size_t first_likely(double share, std::size_t samples) {
  const boost::math::binomial b(static_cast<double>(samples), share);
  std::size_t low = 0, high = samples;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (boost::math::cdf(b, static_cast<double>(middle)) > kOutside)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

Estimate mean_of(std::span<const double> values, double deviation) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) sum += value;
  const double mean = sum / n;
  if (values.size() < 2) return {mean, kNone, kNone};
  const double t = boost::math::quantile(boost::math::students_t(n - 1.0), 1.0 - kOutside);
  const double reach = t * deviation / std::sqrt(n);
  return {mean, mean - reach, mean + reach};
}

double deviation_of(std::span<const double> values) {
  if (values.size() < 2) return kNone;
  const auto n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : values) sum += value;
  const double mean = sum / n;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / (n - 1.0));
}

// sorted: not empty.
Estimate quantile_of(std::span<const double> sorted, double share, Ranks ranks) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto before = static_cast<std::size_t>(place);
  const std::size_t after = std::min(before + 1, sorted.size() - 1);
  return {std::lerp(sorted[before], sorted[after], place - static_cast<double>(before)),
          ranks.low == 0 ? -kInfinity : sorted[ranks.low - 1],
          ranks.high > sorted.size() ? kInfinity : sorted[ranks.high - 1]};
}

}  // namespace

// The number B of samples below the quantile is binomial, and x_(l) <= quantile < x_(u) where l <= B < u: so
// P(B < l) and P(B >= u) are kOutside at most (H. A. David and H. N. Nagaraja, Order Statistics, 2003, 7.1).
Ranks ranks_about(double share, std::size_t samples) {
  // l is the largest with P(B <= l - 1) <= kOutside.
  const std::size_t low = first_likely(share, samples);
  // n - B is binomial with 1 - share, and P(B >= u) = P(n - B <= n - u).
  const std::size_t high = samples + 1 - first_likely(1.0 - share, samples);
  return {low, high};
}

Scatter ScatterOf::operator()(std::span<double> values) {
  const auto end = std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); });
  const std::span<double> valid(values.begin(), end);
  std::sort(valid.begin(), valid.end());
  Scatter scatter{.samples = valid.size(),
                  .mean = {kNone, kNone, kNone},
                  .deviation = deviation_of(valid),
                  .quantiles = {}};
  scatter.quantiles.assign(shares_.size(), {kNone, kNone, kNone});
  if (valid.empty()) return scatter;
  scatter.mean = mean_of(valid, scatter.deviation);
  if (samples_ != valid.size()) {
    ranks_.clear();
    for (const double share : shares_) ranks_.push_back(ranks_about(share, valid.size()));
    samples_ = valid.size();
  }
  for (std::size_t q = 0; q < shares_.size(); ++q)
    scatter.quantiles[q] = quantile_of(valid, shares_[q], ranks_[q]);
  return scatter;
}

Eigen::VectorXd means(const Eigen::MatrixXd& samples) {
  return samples.colwise().mean();
}

Eigen::MatrixXd covariance(const Eigen::MatrixXd& samples) {
  const Eigen::MatrixXd about = samples.rowwise() - samples.colwise().mean();
  return about.transpose() * about / std::max(1.0, static_cast<double>(samples.rows() - 1));
}

}  // namespace frahm::samples
