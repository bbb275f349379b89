#include "solvers/identification/log_decrement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/identification/decay_fit.hpp"
#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

using Index = Eigen::Index;
using std::numbers::pi;

// The extremes of the first cycles that are well above the noise: otherwise their logarithm is skewed.
DecayExtrema used(const DecayExtrema& all, std::size_t most) {
  constexpr double kAboveNoise = 5.0;  // standard errors
  std::size_t n = std::min(most, all.displacement.size());
  const auto clear = [&](std::size_t i) {
    return all.displacement[i] != 0.0 &&
           (all.displacement_sigma.empty() ||
            std::abs(all.displacement[i]) > kAboveNoise * all.displacement_sigma[i]);
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (!clear(i)) n = i;
  }
  const auto first = [n](const std::vector<double>& values) {
    return std::vector<double>(values.begin(),
                               values.begin() + static_cast<std::ptrdiff_t>(std::min(n, values.size())));
  };
  return {first(all.time), first(all.displacement), first(all.time_sigma), first(all.displacement_sigma),
          all.degrees_of_freedom};
}

struct Decrements {
  Index cycles;
  double regression, over_cycles;
  Eigen::Matrix2d covariance;
  double degrees_of_freedom;
  Eigen::VectorXd fitted;  // extremes [m]
};

Decrements decrements(const DecayExtrema& extrema) {
  const auto n = static_cast<Index>(extrema.displacement.size());
  const Eigen::Map<const Eigen::VectorXd> x(extrema.displacement.data(), n);
  const Eigen::VectorXd size = x.cwiseAbs(), logarithm = size.array().log();
  // The sigma of ln|x| is sigma / |x|; without known sigmas all extremes have the same.
  const Eigen::VectorXd sigma = displacement_sigma(extrema).cwiseQuotient(size);
  Eigen::MatrixXd A(n, 2);  // ln|x_i| = ln|x_0| - delta i / 2
  A << Eigen::VectorXd::Ones(n), -0.5 * Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
  const LinearFit line = linear_fit(A, logarithm, sigma);
  const Index cycles = (n - 1) / 2;
  // delta = ln(x_0 / x_2N) / N
  Eigen::MatrixXd by_logarithm = Eigen::MatrixXd::Zero(2, n);
  by_logarithm.row(0) = line.influence.row(1);
  by_logarithm(1, 0) = 1.0 / static_cast<double>(cycles);
  by_logarithm(1, 2 * cycles) = -by_logarithm(1, 0);
  const bool known = !extrema.displacement_sigma.empty();
  const Scatter s =
      scatter(line.chi_squared, line.degrees_of_freedom, known ? extrema.degrees_of_freedom : 0.0);
  const Eigen::MatrixXd spread = by_logarithm * sigma.asDiagonal();
  const Eigen::VectorXd fitted = (A * line.p).array().exp() * x.array().sign();
  return {cycles,
          line.p[1],
          by_logarithm.row(1).dot(logarithm),
          s.variance * spread * spread.transpose(),
          s.degrees_of_freedom,
          fitted};
}

// zeta = delta / sqrt(4 pi^2 + delta^2), and delta / (2 pi)
void add_ratios(Identification& result, const std::string& suffix, double delta) {
  const std::string from = "log_decrement" + suffix;
  const std::string how = suffix.empty() ? "" : ", from the first and the last extreme of the cycles";
  const double root = std::sqrt(4.0 * pi * pi + delta * delta);
  add_from(result,
           {.name = "damping_ratio" + suffix,
            .unit = "1",
            .long_name = "damping ratio" + how,
            .value = delta / root},
           {{from.c_str(), 4.0 * pi * pi / (root * root * root)}});
  add_from(result,
           {.name = "damping_ratio_first_order" + suffix,
            .unit = "1",
            .long_name = "damping ratio to first order" + how,
            .value = delta / (2.0 * pi)},
           {{from.c_str(), 1.0 / (2.0 * pi)}});
}

}  // namespace

Identification log_decrement(const DecayExtrema& extrema, std::optional<std::size_t> cycles) {
  constexpr std::size_t kLeast = 3;  // a cycle
  if (cycles && *cycles == 0)
    return no_result("the decrement is taken over 0 cycles: at least one is needed");
  if (const std::string why = unless_decaying(extrema, kLeast); !why.empty()) return no_result(why);
  const std::size_t least = cycles ? 2 * *cycles + 1 : kLeast;
  const DecayExtrema taken = used(extrema, cycles ? least : extrema.displacement.size());
  if (taken.displacement.size() < least)
    return no_result(std::to_string(least) + " extremes above the noise are needed for " +
                     std::to_string((least - 1) / 2) + " cycles, there are " +
                     std::to_string(taken.displacement.size()));
  const Decrements found = decrements(taken);
  Identification result;
  result.estimates = {
      {.name = "log_decrement", .unit = "1", .long_name = "logarithmic decrement", .value = found.regression},
      {.name = "log_decrement_over_cycles",
       .unit = "1",
       .long_name = "logarithmic decrement from the first and the last extreme of the cycles",
       .value = found.over_cycles}};
  result.covariance = found.covariance;
  result.degrees_of_freedom = found.degrees_of_freedom;
  add_ratios(result, "", found.regression);
  add_ratios(result, "_over_cycles", found.over_cycles);
  add_frequencies(taken, found.regression / std::hypot(2.0 * pi, found.regression), result);
  result.records = {extrema_record(taken, found.fitted)};
  result.notes.push_back("over " + std::to_string(found.cycles) + " cycles, " +
                         std::to_string(taken.displacement.size()) + " extremes");
  set_intervals(result);
  return result;
}

Identification log_decrement(std::span<const double> time, std::span<const double> displacement,
                             std::optional<std::size_t> cycles) {
  const FoundExtrema found = find_extrema(time, displacement);
  if (!found.failure.empty()) return no_result(found.failure);
  Identification result = log_decrement(found.extrema, cycles);
  result.notes.insert(result.notes.end(), found.notes.begin(), found.notes.end());
  return result;
}

}  // namespace frahm::identification
