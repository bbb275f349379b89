#include "solvers/identification/decay_extrema.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/identification/record_faults.hpp"
#include "solvers/identification/statement.hpp"
#include "solvers/identification/turning_point.hpp"

namespace frahm::identification {
namespace {

using Index = Eigen::Index;
using Samples = std::span<const double>;

std::string wrong(Samples time, Samples displacement) {
  const std::string bad =
      first_of({unless_equal("time and displacement", {time.size(), displacement.size()}),
                unless_finite("time", time), unless_finite("displacement", displacement)});
  if (!bad.empty()) return bad;
  if (time.size() < kLeastSamples)
    return "the record has " + std::to_string(time.size()) + " samples, it needs " +
           std::to_string(kLeastSamples) + " at least";
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (!(time[i] > time[i - 1]))
      return "time " + std::to_string(i + 1) + " is " + number(time[i]) + " s after " + number(time[i - 1]) +
             " s: times must increase";
  }
  return "";
}

// The distance of sample i from the polynomial through its three neighbours on either side, over the distance
// that noise of 1 in each of the seven would give.
double off_neighbours(Samples time, Samples x, std::size_t i) {
  double passes = 0.0, squares = 1.0;
  for (std::size_t j = i - 3; j <= i + 3; ++j) {
    if (j == i) continue;
    double lagrange = 1.0;
    for (std::size_t k = i - 3; k <= i + 3; ++k) {
      if (k != i && k != j) lagrange *= (time[i] - time[k]) / (time[j] - time[k]);
    }
    passes += lagrange * x[j];
    squares += lagrange * lagrange;
  }
  return std::abs(x[i] - passes) / std::sqrt(squares);
}

// Standard deviation of white noise, by the median, which the few samples about a stop do not disturb.
double noise_of(Samples time, Samples x) {
  constexpr double kMedian = 0.6744897501960817;  // of |noise| / sigma of a normal distribution
  std::vector<double> off;
  for (std::size_t i = 3; i + 3 < x.size(); ++i) off.push_back(off_neighbours(time, x, i));
  std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
  return off[off.size() / 2] / kMedian;
}

// The samples at which the trace turns by more than `swing` after having swung by more than it.
// A first sample may be among them, and the end of the last swing is not.
std::vector<std::size_t> turns(Samples x, double swing) {
  std::vector<std::size_t> found;
  std::size_t top = 0, bottom = 0;
  int direction = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (x[i] > x[top]) top = i;
    if (x[i] < x[bottom]) bottom = i;
    if (direction >= 0 && x[top] - x[i] > swing) {
      found.push_back(top);
      direction = -1;
      bottom = i;
    } else if (direction <= 0 && x[i] - x[bottom] > swing) {
      found.push_back(bottom);
      direction = 1;
      top = i;
    }
  }
  return found;
}

// The free vibration: its half period [s], and delta of exp(-delta s) cos s, s = pi t / half period.
struct Shape {
  double half_period = 0.0, decrease = 0.0;
};

// The samples within half the way to the neighbours of turn k; empty where less than half of a side is there.
Quarters quarters_of(Samples time, Samples x, const std::vector<std::size_t>& turns, std::size_t k,
                     Shape shape) {
  const double at = time[turns[k]];
  const double before = k > 0 ? at - time[turns[k - 1]] : time[turns[k + 1]] - at;
  const double after = k + 1 < turns.size() ? time[turns[k + 1]] - at : before;
  const double from = at - 0.5 * before, to = at + 0.5 * after;
  Quarters quarters{at, shape.half_period / std::numbers::pi, shape.decrease, {}, {}};
  if (at - time.front() < 0.25 * before || time.back() - at < 0.25 * after) return quarters;
  const auto first =
      static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), from) - time.begin());
  const auto end = static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), to) - time.begin());
  const auto n = static_cast<Index>(end - first);
  quarters.phase = (Eigen::Map<const Eigen::VectorXd>(&time[first], n).array() - at) / quarters.radian;
  quarters.x = Eigen::Map<const Eigen::VectorXd>(&x[first], n);
  return quarters;
}

FoundExtrema none(std::string why) {
  FoundExtrema found;
  found.failure = std::move(why);
  return found;
}

// The turning points in order, for one half period.
struct Turns {
  std::vector<Quarters> quarters;
  std::vector<TurningPoint> fits;
  double rss = 0.0, degrees_of_freedom = 0.0;  // [m^2]

  double time(std::size_t k) const { return quarters[k].at + quarters[k].radian * fits[k].phase; }
  // The mean half period; delta of phi_3 next to phi_2, a_3 = -2 delta' a_2, by least squares over all turns.
  Shape shape() const {
    double product = 0.0, square = 0.0;
    for (const TurningPoint& fit : fits) {
      if (fit.before.size() < 2) continue;
      product += fit.before[0] * fit.before[1];
      square += fit.before[0] * fit.before[0];
    }
    constexpr double kMost = 1.0;
    const double more = square > 0.0 ? -0.5 * product / square : 0.0;
    return {(time(fits.size() - 1) - time(0)) / static_cast<double>(fits.size() - 1),
            std::clamp(quarters[0].decrease + more, -kMost, kMost)};
  }
};

Turns fit_turns(Samples time, Samples x, const std::vector<std::size_t>& turned, Shape shape) {
  Turns turns;
  for (std::size_t k = 0; k < turned.size(); ++k) {
    const Quarters quarters = quarters_of(time, x, turned, k, shape);
    const TurningPoint fit = turning_point(quarters);
    // A gap would break the turn from maximum to minimum: only the first and the last may be missing.
    if (!fit.converged && !turns.fits.empty()) break;
    if (!fit.converged) continue;
    turns.rss += fit.rss;
    turns.degrees_of_freedom += static_cast<double>(quarters.phase.size() - fit.unknowns);
    turns.quarters.push_back(quarters);
    turns.fits.push_back(fit);
  }
  return turns;
}

// Standard errors: every sample has the noise that all the fits together leave.
FoundExtrema found_of(const Turns& turns) {
  FoundExtrema found;
  found.extrema.degrees_of_freedom = turns.degrees_of_freedom;
  found.noise = turns.degrees_of_freedom > 0.0 ? std::sqrt(turns.rss / turns.degrees_of_freedom) : 0.0;
  for (std::size_t k = 0; k < turns.fits.size(); ++k) {
    const TurningPoint& fit = turns.fits[k];
    found.extrema.time.push_back(turns.time(k));
    found.extrema.displacement.push_back(fit.x);
    if (!(turns.degrees_of_freedom > 0.0)) continue;
    const double sigma = std::max(found.noise, fit.rounding);
    found.extrema.displacement_sigma.push_back(sigma * std::sqrt(fit.cofactor(0, 0)));
    found.extrema.time_sigma.push_back(sigma * std::sqrt(fit.cofactor(1, 1)) * turns.quarters[k].radian);
  }
  return found;
}

}  // namespace

FoundExtrema find_extrema(Samples time, Samples displacement) {
  if (const std::string why = wrong(time, displacement); !why.empty()) return none(why);
  // Noise makes no swing of ten standard deviations in a million samples; twice that swing turns at samples
  // that show the turn. A billionth of the whole is rounding.
  constexpr double kAboveNoise = 20.0, kAboveRounding = 1e-9;
  const auto [least, most] = std::minmax_element(displacement.begin(), displacement.end());
  const double noise = noise_of(time, displacement);
  if (const std::string wild = unless_wild(time, displacement, noise); !wild.empty()) return none(wild);
  const double swing = std::max(kAboveNoise * noise, kAboveRounding * (*most - *least));
  const std::vector<std::size_t> turned = turns(displacement, swing);
  if (turned.size() < 2)
    return none("the record turns " + std::to_string(turned.size()) + " times by more than " + number(swing) +
                " m, the threshold of " + number(kAboveNoise) + " standard deviations of its noise, " +
                number(noise) + " m: at least two turning points are needed");
  if (const std::string fault = unless_whole(time, displacement, turned); !fault.empty()) return none(fault);
  // The turning samples give a first shape for the fits, which then give a better one.
  const double half_period =
      (time[turned.back()] - time[turned.front()]) / static_cast<double>(turned.size() - 1);
  Turns fitted = fit_turns(time, displacement, turned, {.half_period = half_period});
  if (fitted.fits.size() > 1) fitted = fit_turns(time, displacement, turned, fitted.shape());
  if (fitted.fits.size() < 2)
    return none("only " + std::to_string(fitted.fits.size()) + " of " + std::to_string(turned.size()) +
                " turning points can be fitted: each needs at least six samples around it, two on either "
                "side, within the record and above the noise");
  FoundExtrema found = found_of(fitted);
  const std::size_t left_out = turned.size() - fitted.fits.size();
  if (left_out > 0)
    found.notes.push_back(
        std::to_string(left_out) + " of " + std::to_string(turned.size()) +
        " turning points lie at the ends of the record or have too few samples, and are left out");
  return found;
}

}  // namespace frahm::identification
