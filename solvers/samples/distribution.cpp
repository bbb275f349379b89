#include "solvers/samples/distribution.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/triangular.hpp>
#include <cmath>

namespace frahm::samples {
namespace {

namespace math = boost::math;

// In double precision everywhere: long doubles differ between machines.
using Policy = math::policies::policy<math::policies::promote_double<false>,
                                      math::policies::overflow_error<math::policies::ignore_error>>;
using Normal = math::normal_distribution<double, Policy>;
using Triangular = math::triangular_distribution<double, Policy>;

// The cuts in standard deviations from the centre, of the number or of its logarithm.
struct Cuts {
  double lower, upper;
};

Cuts cuts_of(const Distribution& distribution) {
  const auto standard = [&](double end) {
    if (distribution.kind == Distribution::Kind::normal)
      return (end - distribution.centre) / distribution.spread;
    if (end <= 0.0) return -kInfinity;
    return std::log(end / distribution.centre) / distribution.spread;
  };
  return {standard(distribution.lower), standard(distribution.upper)};
}

double below(double x) {
  if (std::isinf(x)) return x < 0.0 ? 0.0 : 1.0;
  return math::cdf(Normal(), x);
}

// Phi^-1(Phi(lower) + share (Phi(upper) - Phi(lower))), from the side on which the shares are small.
double cut_normal(Cuts cuts, double share) {
  if (cuts.lower > 0.0) return -cut_normal({-cuts.upper, -cuts.lower}, 1.0 - share);
  const double first = below(cuts.lower), last = below(cuts.upper);
  return std::clamp(standard_normal(first + share * (last - first)), cuts.lower, cuts.upper);
}

bool has_cuts(const Distribution& distribution) {
  return distribution.kind == Distribution::Kind::normal ||
         distribution.kind == Distribution::Kind::lognormal;
}

}  // namespace

double standard_normal(double share) {
  if (share <= 0.0 || share >= 1.0) return share <= 0.0 ? -kInfinity : kInfinity;
  return math::quantile(Normal(), share);
}

// Var / mean^2 = exp(s^2) - 1.
double log_deviation(double variation) {
  return std::sqrt(std::log1p(variation * variation));
}

// Var / median^2 = y (y - 1) with y = exp(s^2), so y = (1 + sqrt(1 + 4 Var / median^2)) / 2.
double log_deviation_by_median(double deviation_over_median) {
  const double y = 0.5 * (1.0 + std::hypot(1.0, 2.0 * deviation_over_median));
  return std::sqrt(std::log(y));
}

double kept_share(const Distribution& distribution) {
  if (!has_cuts(distribution)) return 1.0;
  const Cuts cuts = cuts_of(distribution);
  return cuts.lower > 0.0 ? below(-cuts.lower) - below(-cuts.upper) : below(cuts.upper) - below(cuts.lower);
}

double quantile(const Distribution& distribution, double share) {
  switch (distribution.kind) {
    case Distribution::Kind::normal:
      return std::clamp(distribution.centre + distribution.spread * cut_normal(cuts_of(distribution), share),
                        distribution.lower, distribution.upper);
    case Distribution::Kind::lognormal:
      return std::clamp(
          distribution.centre * std::exp(distribution.spread * cut_normal(cuts_of(distribution), share)),
          distribution.lower, distribution.upper);
    case Distribution::Kind::uniform:
      return std::lerp(distribution.lower, distribution.upper, share);
    case Distribution::Kind::triangular:
      return math::quantile(Triangular(distribution.lower, distribution.centre, distribution.upper), share);
  }
  return kNone;
}

}  // namespace frahm::samples
