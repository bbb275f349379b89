#pragma once

#include "solvers/algebra/no_value.hpp"

// Distributions of uncertain parameters.
namespace frahm::samples {

// A distribution of one number, in the number's own unit.
struct Distribution {
  enum class Kind { normal, lognormal, uniform, triangular };

  Kind kind = Kind::normal;
  double centre = 0.0;  // normal: the mean; lognormal: the median, > 0; triangular: the mode
  double spread = 1.0;  // > 0; normal: the standard deviation; lognormal: that of the logarithm
  // Uniform and triangular: the ends, finite. Normal and lognormal: where they are cut off.
  double lower = -kInfinity, upper = kInfinity;
};

// The standard deviation of the logarithm of a lognormal number, from its coefficient of variation
// (deviation over mean).
double log_deviation(double variation);
// The same from its standard deviation over its median.
double log_deviation_by_median(double deviation_over_median);

// The part of a normal or lognormal distribution that lies between its cuts; 1 of the others.
double kept_share(const Distribution& distribution);

// The number below which a share of the distribution lies, the cuts included.  0 < share < 1.
double quantile(const Distribution& distribution, double share);

}  // namespace frahm::samples
