#include "solvers/identification/grey_box.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/shortest_solution.hpp"
#include "solvers/identification/minima.hpp"

namespace frahm::identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd, Eigen::VectorXd;

// Covariance of the unknowns and the fixed ones; S = -(J^T J)^-1 J^T J_f is the fit's change with the latter:
//   [ s^2 (J^T J)^-1 + S cov_f S^T,  S cov_f ]
//   [ cov_f S^T,                       cov_f ]
// What is not determined stays so.
MatrixXd with_fixed(const MatrixXd& own, const MatrixXd& J, const MatrixXd& J_fixed,
                    const MatrixXd& fixed_covariance, const VectorXd& scales) {
  const Index n = own.rows(), f = fixed_covariance.rows();
  if (f == 0) return own;
  const MatrixXd scaled = J * scales.asDiagonal();
  const MatrixXd S = -(scales.asDiagonal() * algebra::shortest_solutions(scaled, J_fixed));
  MatrixXd joint(n + f, n + f);
  joint.topLeftCorner(n, n) = S * fixed_covariance * S.transpose();
  joint.topRightCorner(n, f) = S * fixed_covariance;
  joint.bottomRightCorner(f, f) = fixed_covariance;
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < n; ++k)
      joint(i, k) = std::isfinite(own(i, k)) ? own(i, k) + joint(i, k) : own(i, k);
    if (!std::isfinite(own(i, i))) joint.topRightCorner(n, f).row(i).setConstant(std::nan(""));
  }
  joint.bottomLeftCorner(f, n) = joint.topRightCorner(n, f).transpose();
  return joint;
}

// Autocorrelation of the residuals from one sample to the next: sum r_i r_{i+1} / sum r_i^2.
double lag_one(const FittedSeries& series) {
  double beside = 0.0, all = 0.0, last = 0.0;
  for (std::size_t i = 0; i < series.measured.size(); ++i) {
    const double r = series.measured[i] - series.fitted[i];
    beside += r * last;
    all += r * r;
    last = r;
  }
  return all > 0.0 ? beside / all : 0.0;
}

std::string percent(double share) {
  std::string digits = std::to_string(share);
  return digits.substr(0, digits.find('.') + 2) + " %";
}

// No note is needed if the data are followed to rounding. A parameter held at a bound already has a note, and
// its residuals are autocorrelated.
void note_quality(const GreyBoxTask& task, bool held, Identification& result) {
  constexpr double kGood = 90.0, kExact = 100.0 - 1e-6, kRepeats = 0.5, kWhite = 0.2;
  for (std::size_t i = 0; i < result.records.size(); ++i) {
    const FittedRecord& record = result.records[i];
    const bool free = task.records[i].motion == MotionKind::free;
    // The residual may be noise alone, which is not autocorrelated.
    const bool white = std::ranges::all_of(
        record.series, [](const FittedSeries& series) { return lag_one(series) <= kWhite; });
    if (record.nrmse < kGood && !white)
      result.notes.push_back("the model misses " + percent(100.0 - record.nrmse) + " of record '" +
                             record.name + "': a wrong model" +
                             (free ? "" : ", a clock that is not the excitation's") + " or a wrong minimum");
    if (held || !(record.nrmse < kExact)) continue;
    for (const FittedSeries& series : record.series) {
      if (lag_one(series) <= kRepeats) continue;
      result.notes.push_back(
          "the residual of " + series.name + " in record '" + record.name +
          "' is not noise, because its values are correlated: the intervals are too narrow");
    }
  }
}

// If the model follows the data to rounding, a parameter at a bound would not be better elsewhere.
void note_bounds(const LeastSquaresFit& fit, const std::vector<Unknown>& unknowns, bool exact,
                 Identification& result) {
  for (std::size_t i = 0; i < unknowns.size() && !exact; ++i) {
    if (fit.at_bound[i] == 0) continue;
    const char* side = fit.at_bound[i] < 0 ? "lower" : "upper";
    result.notes.push_back("`" + unknowns[i].name + "` is held by its " + side +
                           " bound, beyond which the fit would be better: do not trust its interval");
  }
}

// |y - f| of all that is measured is rounding.
bool is_exact(const std::vector<FittedRecord>& records) {
  constexpr double kRounding = 1e-12;
  for (const FittedRecord& record : records) {
    for (const FittedSeries& series : record.series) {
      const auto size = static_cast<Index>(series.measured.size());
      const Eigen::Map<const VectorXd> y(series.measured.data(), size), f(series.fitted.data(), size);
      if ((y - f).norm() > kRounding * y.norm()) return false;
    }
  }
  return true;
}

// Degrees of freedom of a sum of two independent estimated variances. Source: Welch-Satterthwaite.
//   nu = (V_1 + V_2)^2 / (V_1^2 / nu_1 + V_2^2 / nu_2)
double degrees_of_sum(double V_1, double nu_1, double V_2, double nu_2) {
  if (!(V_2 > 0.0)) return nu_1;
  return (V_1 + V_2) * (V_1 + V_2) / (V_1 * V_1 / nu_1 + V_2 * V_2 / nu_2);
}

// The fixed ones keep their own; the part of the fitted ones' variance that comes from the fixed ones counts
// as one variance, with the fewest degrees of freedom among these.
void set_degrees_of_freedom(const GreyBoxTask& task, const MatrixXd& own, Identification& result) {
  double fixed = kInfinity;
  for (const FixedParameter& each : task.fixed) fixed = std::min(fixed, each.degrees_of_freedom);
  const auto fitted = static_cast<std::size_t>(own.rows());
  for (std::size_t i = 0; i < result.estimates.size(); ++i) {
    const auto place = static_cast<Index>(i);
    double& degrees = result.estimates[i].degrees_of_freedom;
    degrees = result.degrees_of_freedom;
    if (i >= fitted)
      degrees = task.fixed[i - fitted].degrees_of_freedom;
    else if (const double V = own(place, place); std::isfinite(V))
      degrees = degrees_of_sum(V, degrees, result.covariance(place, place) - V, fixed);
  }
}

void estimate(const GreyBoxTask& task, Misfit& misfit, const LeastSquaresFit& fit, Identification& result) {
  const std::vector<Unknown>& unknowns = misfit.unknowns();
  VectorXd scales(fit.p.size()), r;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const auto place = static_cast<Index>(i);
    const std::string& name = task.parameters[misfit.parameter(i)].name;
    result.estimates.push_back({.name = unknowns[i].name,
                                .unit = task.parameters[misfit.parameter(i)].unit,
                                .long_name = "fitted " + name,
                                .value = fit.p[place]});
    scales[place] = std::max(std::abs(fit.p[place]), 1e-3 * unknowns[i].scale);
  }
  for (const FixedParameter& fixed : task.fixed)
    result.estimates.push_back({.name = fixed.name,
                                .unit = fixed.unit,
                                .long_name = fixed.name + " as identified before",
                                .value = fixed.value});
  result.degrees_of_freedom = static_cast<double>(fit.residuals.size() - fit.p.size());
  const double variance =
      result.degrees_of_freedom > 0.0 ? fit.sum_of_squares() / result.degrees_of_freedom : kNone;
  MatrixXd J, J_fixed;
  if (!misfit.evaluate(fit.p, r, &J, &J_fixed)) {
    J = fit.jacobian;
    J_fixed.setZero();
    result.notes.push_back(
        "the motion has no derivative with respect to the estimates used from before, so their uncertainty "
        "is left out: " +
        misfit.reason());
  }
  const MatrixXd own = covariance(J, variance, scales);
  result.covariance = with_fixed(own, J, J_fixed, task.fixed_covariance, scales);
  set_degrees_of_freedom(task, own, result);
  set_intervals(result);
}

// If another minimum is as low to within noise, the parabola about this one is not enough: the intervals
// reach as far about the other minimum as about this one.
void span_rivals(const std::vector<VectorXd>& rivals, Identification& result) {
  if (rivals.empty()) return;
  for (Index i = 0; i < rivals.front().size(); ++i) {
    Estimate& estimate = result.estimates[static_cast<std::size_t>(i)];
    const double below = estimate.value - estimate.low, above = estimate.high - estimate.value;
    for (const VectorXd& rival : rivals) {
      estimate.low = std::min(estimate.low, rival[i] - below);
      estimate.high = std::max(estimate.high, rival[i] + above);
    }
  }
  result.notes.push_back(
      "another minimum is equally low within the noise, for example with one half swing more or fewer before "
      "rest: the intervals span both, and reach beyond their standard errors");
}

// Weights by the residuals, until they settle.
LeastSquaresFit weigh(Misfit& misfit, Minima& minima, LeastSquaresFit fit) {
  constexpr int kMostRounds = 8;
  constexpr double kSettled = 0.01;
  for (int round = 0; round < kMostRounds; ++round) {
    const double change = misfit.weigh_by_residuals(fit.p);
    fit = minima.from(fit.p);
    if (change < kSettled) break;
  }
  return fit;
}

LeastSquaresFit least_misfit(Misfit& misfit, Minima& minima) {
  LeastSquaresFit fit = minima.from_start();
  if (misfit.series() == 1 || fit.jacobian.size() == 0 || !misfit.moves(fit.p)) return fit;
  fit = weigh(misfit, minima, std::move(fit));
  const double sum = fit.sum_of_squares();
  fit = minima.beside(std::move(fit));
  return fit.sum_of_squares() < sum ? weigh(misfit, minima, std::move(fit)) : fit;
}

// Why the residuals cannot determine the unknowns; "": they may.
std::string too_few(const Misfit& misfit) {
  const std::size_t unknowns = misfit.unknowns().size();
  if (misfit.residuals() >= static_cast<Index>(unknowns)) return "";
  return "the records have " + std::to_string(misfit.residuals()) + " measured values for " +
         std::to_string(unknowns) + " unknowns: at least as many values as unknowns are needed";
}

// ": " and why the model cannot be computed or differentiated at p; "": it can.
std::string why_no_derivative(Misfit& misfit, const VectorXd& p) {
  VectorXd r;
  MatrixXd J;
  if (p.size() == 0 || misfit(p, r, &J) || misfit.reason().empty()) return "";
  return ": " + misfit.reason();
}

}  // namespace

Identification grey_box(const GreyBoxTask& task) {
  Misfit misfit(task);
  Identification result;
  VectorXd r;
  if (!misfit.evaluate(misfit.start(), r, nullptr, nullptr)) {
    result.failure = "the model cannot be simulated where the fit starts: " + misfit.reason();
    return result;
  }
  result.failure = too_few(misfit);
  if (!result.failure.empty()) return result;
  Minima minima(task, misfit, result.iterations);
  const LeastSquaresFit fit = least_misfit(misfit, minima);
  const bool moves = fit.jacobian.size() > 0 && misfit.moves(fit.p);
  result.converged = fit.converged && moves;
  if (!fit.converged || fit.jacobian.size() == 0) {
    const std::string what = "the fit did not find a least sum of squares: " + fit.reason;
    if (fit.jacobian.size() == 0) {
      result.failure = what + why_no_derivative(misfit, fit.p);
      return result;
    }
    result.notes.push_back(what + "; these are the best values found");
  }
  if (!moves)
    result.notes.push_back(
        "nothing moves at the best values found, so no direction of improvement is known: start elsewhere, "
        "with less friction");
  estimate(task, misfit, fit, result);
  result.records = misfit.fitted(fit.p);
  note_bounds(fit, misfit.unknowns(), is_exact(result.records), result);
  const bool held = std::ranges::any_of(fit.at_bound, [](int side) { return side != 0; });
  if (!held) span_rivals(minima.rivals(), result);  // the neighbourhood of a bound is not noise
  note_quality(task, held, result);
  return result;
}

}  // namespace frahm::identification
