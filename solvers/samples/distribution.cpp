#include "solvers/samples/distribution.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/samples/elementary.hpp"

namespace frahm::samples {
namespace {

// The cuts in standard deviations from the centre, of the number or of its logarithm.
struct Cuts {
  double lower, upper;
};

Cuts cuts_of(const Distribution& distribution) {
  const auto standard = [&](double end) {
    if (distribution.kind == Distribution::Kind::normal)
      return (end - distribution.centre) / distribution.spread;
    if (end <= 0.0) return -kInfinity;
    return logarithm(end / distribution.centre) / distribution.spread;
  };
  return {standard(distribution.lower), standard(distribution.upper)};
}

// Phi^-1(Phi(lower) + share (Phi(upper) - Phi(lower))), from the side on which the shares are small.
double cut_normal(Cuts cuts, double share) {
  if (cuts.lower > 0.0) return -cut_normal({-cuts.upper, -cuts.lower}, 1.0 - share);
  const double first = normal_share(cuts.lower), last = normal_share(cuts.upper);
  return std::clamp(standard_normal(first + share * (last - first)), cuts.lower, cuts.upper);
}

// Below the mode the share is (x - a)^2/((b - a)(m - a)), above it 1 - (b - x)^2/((b - a)(b - m)).
double triangular(const Distribution& distribution, double share) {
  const auto& [kind, mode, spread, lower, upper] = distribution;
  const double range = upper - lower;
  if (share * range < mode - lower) return lower + std::sqrt(share * range * (mode - lower));
  return upper - std::sqrt((1.0 - share) * range * (upper - mode));
}

bool has_cuts(const Distribution& distribution) {
  return distribution.kind == Distribution::Kind::normal ||
         distribution.kind == Distribution::Kind::lognormal;
}

}  // namespace

// Var / mean^2 = exp(s^2) - 1.
double log_deviation(double variation) {
  return std::sqrt(logarithm_of_1_and(variation * variation));
}

// Var / median^2 = y (y - 1) with y = exp(s^2), so y = (1 + sqrt(1 + 4 Var / median^2)) / 2.
double log_deviation_by_median(double deviation_over_median) {
  const double part = 2.0 * deviation_over_median, root = std::sqrt(1.0 + part * part);
  return std::sqrt(logarithm_of_1_and(0.5 * part * part / (1.0 + root)));  // y - 1 without cancellation
}

double kept_share(const Distribution& distribution) {
  if (!has_cuts(distribution)) return 1.0;
  const Cuts cuts = cuts_of(distribution);
  return cuts.lower > 0.0 ? normal_share(-cuts.lower) - normal_share(-cuts.upper)
                          : normal_share(cuts.upper) - normal_share(cuts.lower);
}

double quantile(const Distribution& distribution, double share) {
  switch (distribution.kind) {
    case Distribution::Kind::normal:
      return std::clamp(distribution.centre + distribution.spread * cut_normal(cuts_of(distribution), share),
                        distribution.lower, distribution.upper);
    case Distribution::Kind::lognormal:
      return std::clamp(
          distribution.centre * exponential(distribution.spread * cut_normal(cuts_of(distribution), share)),
          distribution.lower, distribution.upper);
    case Distribution::Kind::uniform:
      return distribution.lower + share * (distribution.upper - distribution.lower);
    case Distribution::Kind::triangular:
      return triangular(distribution, share);
  }
  return kNone;
}

}  // namespace frahm::samples
