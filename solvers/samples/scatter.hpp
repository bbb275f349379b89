#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// What a sample says of the distribution from which it was drawn.
namespace frahm::samples {

// An estimate and the ends of its interval.
struct Estimate {
  double value, low, high;
};

struct Scatter {
  std::size_t samples = 0;  // those with a value
  Estimate mean;            // NaN without a sample; the ends NaN with fewer than two
  double deviation;         // standard deviation, of n - 1; NaN with fewer than two samples
  std::vector<Estimate> quantiles;
};

inline constexpr double kConfidence = 0.95;

// The samples whose values, in rising order and numbered from 1, are the ends of an interval that holds the
// quantile of a share with a probability of kConfidence at least, whatever the distribution; 0 for the lower
// end, samples + 1 for the upper: no end.
struct Ranks {
  std::size_t low = 0, high = 0;
};
Ranks ranks_about(double share, std::size_t samples);

// Estimates from the samples of one number, at these shares; keeps the ranks between calls.
class ScatterOf {
 public:
  explicit ScatterOf(std::vector<double> shares) : shares_(std::move(shares)) {}

  // values: reordered; NaN: no value.
  // mean: with the interval of Student's t. It is the usual one: exact for normal numbers, good for any in
  // large samples.
  // quantiles: interpolated as numpy's are (R. J. Hyndman and Y. Fan, Am. Stat. 50 (1996) 361, type 7); the
  // interval between two order statistics, infinite where the sample is too small to have an end.
  // For the points of Sobol or a latin hypercube, which lie more evenly than independent ones, both intervals
  // are as a rule wider than they need be.
  Scatter operator()(std::span<double> values);

 private:
  std::vector<double> shares_;
  std::size_t samples_ = 0;   // of ranks_
  std::vector<Ranks> ranks_;  // of each share
};

// The means and the covariance (of n - 1) of several numbers.  samples: a row each.
Eigen::VectorXd means(const Eigen::MatrixXd& samples);
Eigen::MatrixXd covariance(const Eigen::MatrixXd& samples);

}  // namespace frahm::samples
