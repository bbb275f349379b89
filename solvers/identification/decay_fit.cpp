#include "solvers/identification/decay_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

using Index = Eigen::Index;

// Whether the vibration grows: a line through the half swings |x_i - x_{i+1}| / 2 over i rises by more than
// its error. A sensor's offset has no part in half swings.
bool grows(const DecayExtrema& extrema) {
  constexpr double kErrors = 3.0, kRounding = 1e-9;
  const auto n = static_cast<Index>(extrema.displacement.size()) - 1;
  Eigen::VectorXd half(n);
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    half[i] = 0.5 * std::abs(extrema.displacement[at] - extrema.displacement[at + 1]);
  }
  Eigen::MatrixXd A(n, 2);
  A << Eigen::VectorXd::Ones(n), Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
  const LinearFit line = linear_fit(A, half, Eigen::VectorXd::Ones(n));
  const double variance = n > 2 ? line.chi_squared / line.degrees_of_freedom : 0.0;
  const double error = std::sqrt(variance) * line.influence.row(1).norm();
  return line.p[1] > std::max(kErrors * error, kRounding * half.maxCoeff());
}

std::string wrong_sizes(const DecayExtrema& extrema) {
  const std::size_t n = extrema.displacement.size();
  const auto sigmas = [n](const std::vector<double>& sigma) { return sigma.empty() ? n : sigma.size(); };
  return first_of(
      {unless_equal("time and displacement", {extrema.time.empty() ? n : extrema.time.size(), n}),
       unless_equal("standard errors and extremes", {n, sigmas(extrema.displacement_sigma)}),
       unless_equal("standard errors and times",
                    {extrema.time.empty() ? 0 : n,
                     extrema.time_sigma.empty() && !extrema.time.empty() ? n : extrema.time_sigma.size()}),
       unless_finite("time", extrema.time), unless_finite("extreme", extrema.displacement),
       unless_positive("standard error", extrema.displacement_sigma),
       unless_positive("standard error", extrema.time_sigma)});
}

// All extremes are half a period apart, if none is missing: a sentence that names two that are not.
std::string uneven(const DecayExtrema& extrema) {
  constexpr double kShort = 0.5, kLong = 1.5;  // half periods
  std::vector<double> apart;
  for (std::size_t i = 1; i < extrema.time.size(); ++i)
    apart.push_back(extrema.time[i] - extrema.time[i - 1]);
  if (apart.empty()) return "";
  std::vector<double> sorted = apart;
  std::sort(sorted.begin(), sorted.end());
  const double half_period = sorted[(sorted.size() - 1) / 2];
  for (std::size_t i = 0; i < apart.size(); ++i) {
    if (apart[i] >= kShort * half_period && apart[i] <= kLong * half_period) continue;
    return "extremes " + std::to_string(i + 1) + " and " + std::to_string(i + 2) + ", at " +
           number(extrema.time[i]) + " and " + number(extrema.time[i + 1]) + " s, are " + number(apart[i]) +
           " s apart, most are " + number(half_period) +
           " s: successive ones are half a period apart, some are missing or too many";
  }
  return "";
}

}  // namespace

std::string unless_decaying(const DecayExtrema& extrema, std::size_t least) {
  if (std::string bad = wrong_sizes(extrema); !bad.empty()) return bad;
  const auto& x = extrema.displacement;
  if (x.size() < least)
    return "at least " + std::to_string(least) + " extremes are needed, there are " +
           std::to_string(x.size());
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (!extrema.time.empty() && !(extrema.time[i] > extrema.time[i - 1]))
      return "the time of extreme " + std::to_string(i + 1) + " is " + number(extrema.time[i]) + " s after " +
             number(extrema.time[i - 1]) + " s: times must increase";
    if (i > 1 && !((x[i] - x[i - 1]) * (x[i - 1] - x[i - 2]) < 0.0))
      return "extremes " + std::to_string(i - 1) + " to " + std::to_string(i + 1) + " are " +
             number(x[i - 2]) + ", " + number(x[i - 1]) + ", " + number(x[i]) +
             " m: maxima and minima must come in turn";
  }
  if (std::string which = uneven(extrema); !which.empty()) return which;
  if (x.size() > 2 && grows(extrema))
    return "the oscillation grows: its first swing is " + number(std::abs(x[1] - x[0])) + " m, its last " +
           number(std::abs(x[x.size() - 1] - x[x.size() - 2])) + " m";
  return "";
}

Eigen::VectorXd displacement_sigma(const DecayExtrema& extrema) {
  const auto n = static_cast<Index>(extrema.displacement.size());
  if (extrema.displacement_sigma.empty()) return Eigen::VectorXd::Ones(n);
  return Eigen::Map<const Eigen::VectorXd>(extrema.displacement_sigma.data(), n);
}

namespace {

struct DampedFrequency {
  double value = 0.0, variance = 0.0;  // [rad/s]
  double degrees_of_freedom = 0.0;
};

// Half a period apart, with Coulomb friction, too: t_i = t_0 + i pi / omega_d
DampedFrequency damped_frequency(const DecayExtrema& extrema) {
  const auto n = static_cast<Index>(extrema.time.size());
  const bool known = !extrema.time_sigma.empty();
  Eigen::VectorXd sigma = Eigen::VectorXd::Ones(n);
  if (known) sigma = Eigen::Map<const Eigen::VectorXd>(extrema.time_sigma.data(), n);
  Eigen::MatrixXd A(n, 2);
  A << Eigen::VectorXd::Ones(n), Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
  const LinearFit line = linear_fit(A, Eigen::Map<const Eigen::VectorXd>(extrema.time.data(), n), sigma);
  const Scatter s =
      scatter(line.chi_squared, line.degrees_of_freedom, known ? extrema.degrees_of_freedom : 0.0);
  const double half_period = line.p[1], omega = std::numbers::pi / half_period;
  const double by_half_period = omega / half_period;
  const double variance = s.variance * (line.influence.row(1) * sigma.asDiagonal()).squaredNorm();
  return {omega, by_half_period * by_half_period * variance, s.degrees_of_freedom};
}

}  // namespace

void add_frequencies(const DecayExtrema& extrema, double zeta, Identification& result) {
  if (extrema.time.empty()) return;
  const DampedFrequency damped = damped_frequency(extrema);
  const double omega_d = damped.value;
  const Index n = result.covariance.rows();
  result.estimates.push_back({.name = "damped_frequency",
                              .unit = "rad s-1",
                              .long_name = "frequency of the damped vibration",
                              .value = omega_d});
  result.covariance.conservativeResizeLike(Eigen::MatrixXd::Zero(n + 1, n + 1));
  result.covariance(n, n) = damped.variance;
  result.degrees_of_freedom = std::min(result.degrees_of_freedom, damped.degrees_of_freedom);
  // omega_n = omega_d / s, s^2 = 1 - zeta^2
  const double squared = 1.0 - zeta * zeta, s = std::sqrt(squared);
  add_from(result,
           {.name = "natural_frequency",
            .unit = "rad s-1",
            .long_name = "undamped natural frequency",
            .value = omega_d / s},
           {{"damped_frequency", 1.0 / s}, {"damping_ratio", omega_d * zeta / (s * squared)}});
}

FittedRecord extrema_record(const DecayExtrema& extrema, const Eigen::VectorXd& fitted) {
  const bool timed = !extrema.time.empty();
  FittedRecord record{.name = "extrema",
                      .over = timed ? "time" : "extremum",
                      .over_unit = timed ? "s" : "1",
                      .at = extrema.time,
                      .series = {}};
  for (std::size_t i = 0; !timed && i < extrema.displacement.size(); ++i)
    record.at.push_back(static_cast<double>(i));
  record.series = {{"displacement", "m", extrema.displacement, {fitted.begin(), fitted.end()}}};
  record.nrmse = nrmse(record.series);
  return record;
}

}  // namespace frahm::identification
