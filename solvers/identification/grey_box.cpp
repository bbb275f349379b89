#include "solvers/identification/grey_box.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/identification/least_squares.hpp"
#include "solvers/identification/simulation.hpp"
#include "solvers/mechanics/linear_system.hpp"

namespace frahm::identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd, Eigen::VectorXd;

// Each record is followed so far in a first fit [periods]: long enough to tell a frequency, and short enough
// that one that is a quarter off slips no more than half a period. Where that leads nowhere, as from friction
// that stops the model long before the measured motion, only so far as it still moves.
constexpr double kFirstPeriods[] = {2.0, 0.25};
// A fit that misses more than this of the measured variation has led nowhere.
constexpr double kNowhere = 0.5;
constexpr std::size_t kSamplesAnUnknown = 4;  // in a first fit, at least
constexpr LeastSquaresOptions kOnTheWay = {.tolerance = 1e-6, .most_evaluations = 50};

// Sensors without noise have the variance of this, of their variation: rounding, and no more weight.
constexpr double kExact = 1e-10;

Eigen::Map<const VectorXd> measured(const Channel& channel, std::size_t samples) {
  return {channel.values.data(), static_cast<Index>(samples)};
}

// |y - mean y|, of a series that does not vary |y|, or 1.
double variation(const Channel& channel) {
  const auto y = measured(channel, channel.values.size());
  const double spread = (y.array() - y.mean()).matrix().norm();
  if (spread > 0.0) return spread;
  return y.norm() > 0.0 ? y.norm() : 1.0;
}

// The residuals of all records as functions of the unknowns.
class Misfit {
 public:
  explicit Misfit(const GreyBoxTask& task) : task_(task) {
    for (const TimeRecord& record : task.records) {
      simulations_.emplace_back(task.network, record, task.watch);
      horizon_.push_back(record.time.size());
      weights_.emplace_back();
      for (const Channel& channel : record.channels) weights_.back().push_back(1.0 / variation(channel));
    }
    for (std::size_t i = 0; i < task.parameters.size(); ++i) add_unknowns(i);
  }

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  VectorXd start() const {
    VectorXd p(static_cast<Index>(unknowns_.size()));
    for (std::size_t i = 0; i < unknowns_.size(); ++i) p[static_cast<Index>(i)] = unknowns_[i].start;
    return p;
  }
  // Of all records: one for each channel.
  std::size_t series() const {
    std::size_t count = 0;
    for (const std::vector<double>& weights : weights_) count += weights.size();
    return count;
  }
  // Which parameter an unknown is.
  std::size_t parameter(std::size_t unknown) const { return parameter_[unknown]; }
  Index residuals() const {
    std::size_t count = 0;
    for (std::size_t r = 0; r < horizon_.size(); ++r) count += horizon_[r] * weights_[r].size();
    return static_cast<Index>(count);
  }

  // As `Residuals` (least_squares.hpp). What the mechanics refuses has none.
  bool operator()(const VectorXd& p, VectorXd& r, MatrixXd* by) {
    try {
      return evaluate(p, r, by, nullptr);
    } catch (const mechanics::MechanicsError& error) {
      reason_ = error.what();
      return false;
    }
  }
  // Throws what the mechanics refuses. by, by_fixed: unless null, derivatives by unknowns and fixed ones.
  bool evaluate(const VectorXd& p, VectorXd& r, MatrixXd* by, MatrixXd* by_fixed);
  const std::string& reason() const { return reason_; }  // why there were none

  // Follows the first `seconds` of each record from now on, and enough to tell every unknown. False: all of
  // each already.
  bool follow(double seconds);
  void follow_all();
  double longest_period(const VectorXd& p);  // of all records [s]

  // 1 / standard deviation of each channel's residuals at p.
  void weigh_by_residuals(const VectorXd& p);
  std::vector<FittedRecord> fitted(const VectorXd& p);

 private:
  void add_unknowns(std::size_t parameter);
  std::vector<double> at(std::size_t record, const VectorXd& p) const;
  Model model(std::size_t record, const VectorXd& p, std::vector<Model>* by) const;
  Index place(std::size_t record, std::size_t parameter) const {
    return static_cast<Index>(first_[parameter] + (task_.parameters[parameter].each_record ? record : 0));
  }

  const GreyBoxTask& task_;
  std::vector<Simulation> simulations_;
  std::vector<std::size_t> horizon_;          // samples of each record that are followed
  std::vector<std::vector<double>> weights_;  // of each record's channels
  std::vector<Unknown> unknowns_;
  std::vector<std::size_t> first_;      // of each parameter: its first unknown
  std::vector<std::size_t> parameter_;  // of each unknown
  std::string reason_;
};

void Misfit::add_unknowns(std::size_t i) {
  const FittedParameter& parameter = task_.parameters[i];
  const double range = parameter.upper - parameter.lower;
  double scale = std::abs(parameter.start);
  if (scale == 0.0) scale = std::isfinite(range) && range > 0.0 ? 0.1 * range : 1.0;
  first_.push_back(unknowns_.size());
  for (std::size_t record = 0; record < (parameter.each_record ? task_.records.size() : 1); ++record) {
    const std::string name =
        parameter.each_record ? parameter.name + "_" + task_.records[record].name : parameter.name;
    unknowns_.push_back({name, parameter.start, parameter.lower, parameter.upper, scale});
    parameter_.push_back(i);
  }
}

std::vector<double> Misfit::at(std::size_t record, const VectorXd& p) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < task_.parameters.size(); ++i) values.push_back(p[place(record, i)]);
  for (const FixedParameter& fixed : task_.fixed) values.push_back(fixed.value);
  return values;
}

Model Misfit::model(std::size_t record, const VectorXd& p, std::vector<Model>* by) const {
  Model result;
  if (by != nullptr) by->clear();
  task_.model_at(record, at(record, p), result, by);
  return result;
}

bool Misfit::evaluate(const VectorXd& p, VectorXd& r, MatrixXd* by, MatrixXd* by_fixed) {
  const std::size_t parameters = task_.parameters.size();
  r.resize(residuals());
  if (by != nullptr) by->setZero(r.size(), static_cast<Index>(unknowns_.size()));
  if (by_fixed != nullptr) by_fixed->setZero(r.size(), static_cast<Index>(task_.fixed.size()));
  periodic::ObservedMotion motion;
  std::vector<Model> directions;
  Index row = 0;
  for (std::size_t record = 0; record < task_.records.size(); ++record) {
    const Model at_p = model(record, p, by != nullptr ? &directions : nullptr);
    if (by != nullptr && by_fixed == nullptr) directions.resize(parameters);
    reason_ = simulations_[record].run(at_p, directions, horizon_[record], motion);
    if (!reason_.empty() || !motion.values.allFinite()) return false;
    const auto samples = static_cast<Index>(horizon_[record]);
    for (std::size_t c = 0; c < weights_[record].size(); ++c, row += samples) {
      const auto column = static_cast<Index>(c);
      const double weight = weights_[record][c];
      r.segment(row, samples) = weight * (motion.values.col(column) -
                                          measured(task_.records[record].channels[c], horizon_[record]));
      for (std::size_t d = 0; d < motion.by.size(); ++d) {
        MatrixXd& matrix = d < parameters ? *by : *by_fixed;
        const Index unknown = d < parameters ? place(record, d) : static_cast<Index>(d - parameters);
        matrix.col(unknown).segment(row, samples) = weight * motion.by[d].col(column);
      }
    }
  }
  return true;
}

bool Misfit::follow(double seconds) {
  bool shorter = false;
  for (std::size_t r = 0; r < horizon_.size(); ++r) {
    const TimeRecord& record = task_.records[r];
    const auto end = std::upper_bound(record.time.begin(), record.time.end(), record.time.front() + seconds);
    const auto samples = static_cast<std::size_t>(end - record.time.begin());
    horizon_[r] = std::min(std::max(samples, kSamplesAnUnknown * unknowns_.size()), record.time.size());
    shorter = shorter || horizon_[r] < record.time.size();
  }
  return shorter;
}

void Misfit::follow_all() {
  for (std::size_t r = 0; r < horizon_.size(); ++r) horizon_[r] = task_.records[r].time.size();
}

double Misfit::longest_period(const VectorXd& p) {
  double longest = 0.0;
  for (std::size_t record = 0; record < simulations_.size(); ++record)
    longest = std::max(longest, simulations_[record].longest_period(model(record, p, nullptr)));
  return longest;
}

// Of N residuals and u unknowns each residual's square is short by the factor (N - u) / N in the mean.
void Misfit::weigh_by_residuals(const VectorXd& p) {
  VectorXd r;
  if (!(*this)(p, r, nullptr)) return;
  const double all = static_cast<double>(r.size());
  const double free = std::max(1.0, all - static_cast<double>(unknowns_.size()));
  Index row = 0;
  for (std::size_t record = 0; record < task_.records.size(); ++record) {
    const auto samples = static_cast<Index>(horizon_[record]);
    for (std::size_t c = 0; c < weights_[record].size(); ++c, row += samples) {
      const double mean_square = r.segment(row, samples).squaredNorm() / static_cast<double>(samples);
      const double exact = kExact * weights_[record][c] * variation(task_.records[record].channels[c]);
      weights_[record][c] /=
          std::max(std::sqrt(mean_square * all / free), exact / std::sqrt(static_cast<double>(samples)));
    }
  }
}

std::vector<FittedRecord> Misfit::fitted(const VectorXd& p) {
  constexpr const char* kUnits[] = {"m", "m s-1", "m s-2"};
  std::vector<FittedRecord> list;
  periodic::ObservedMotion motion;
  for (std::size_t record = 0; record < task_.records.size(); ++record) {
    const TimeRecord& of = task_.records[record];
    simulations_[record].run(model(record, p, nullptr), {}, of.time.size(), motion);
    FittedRecord fit{of.name, "time", "s", of.time, {}, 0.0};
    for (std::size_t c = 0; c < of.channels.size(); ++c) {
      const auto column = motion.values.col(static_cast<Index>(c));
      const Channel& channel = of.channels[c];
      fit.series.push_back({channel.name, kUnits[static_cast<int>(channel.signal)], channel.values,
                            std::vector<double>(column.begin(), column.end())});
    }
    fit.nrmse = nrmse(fit.series);
    list.push_back(std::move(fit));
  }
  return list;
}

void start_at(const VectorXd& p, std::vector<Unknown>& unknowns) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) unknowns[i].start = p[static_cast<Index>(i)];
}

// The records' beginnings first, twice as much of them each time. Changes the unknowns' starts to those for
// all of the records, unless growing has come no nearer.
void grow(Misfit& misfit, double periods, std::vector<Unknown>& unknowns, const Residuals& residuals,
          int& iterations) {
  const VectorXd start = misfit.start();
  VectorXd p = start, r, grown_r;
  std::vector<Unknown> grown = unknowns;
  for (double seconds = periods * misfit.longest_period(start); misfit.follow(seconds); seconds *= 2.0) {
    const LeastSquaresFit fit = least_squares(grown, residuals, kOnTheWay);
    iterations += fit.iterations;
    if (fit.p.size() == 0 || !fit.p.allFinite()) break;
    p = fit.p;
    start_at(p, grown);
  }
  misfit.follow_all();
  if (!residuals(p, grown_r, nullptr)) return;
  if (residuals(start, r, nullptr) && !(grown_r.squaredNorm() < r.squaredNorm())) return;
  unknowns = std::move(grown);
}

// Of the unknowns and the fixed ones together, S = -(J^T J)^-1 J^T J_f being how the fit follows the latter:
//   [ s^2 (J^T J)^-1 + S cov_f S^T,  S cov_f ]
//   [ cov_f S^T,                       cov_f ]
// What is not determined stays so.
MatrixXd with_fixed(const MatrixXd& own, const MatrixXd& J, const MatrixXd& J_fixed,
                    const MatrixXd& fixed_covariance, const VectorXd& scales) {
  const Index n = own.rows(), f = fixed_covariance.rows();
  if (f == 0) return own;
  const Eigen::CompleteOrthogonalDecomposition<MatrixXd> scaled(J * scales.asDiagonal());
  const MatrixXd S = -(scales.asDiagonal() * scaled.solve(J_fixed));
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

void note_bounds(const LeastSquaresFit& fit, const std::vector<Unknown>& unknowns, Identification& result) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (fit.at_bound[i] == 0) continue;
    const char* side = fit.at_bound[i] < 0 ? "lower" : "upper";
    result.notes.push_back("`" + unknowns[i].name + "` is held by its " + side +
                           " bound, beyond which the fit would be better: its interval is not to be trusted");
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
                                .long_name = fixed.name + " as found before",
                                .value = fixed.value});
  result.degrees_of_freedom = static_cast<double>(fit.residuals.size() - fit.p.size());
  const double variance = result.degrees_of_freedom > 0.0 ? fit.sum_of_squares() / result.degrees_of_freedom
                                                          : std::numeric_limits<double>::quiet_NaN();
  MatrixXd J, J_fixed;
  if (!misfit.evaluate(fit.p, r, &J, &J_fixed)) J = fit.jacobian;
  result.covariance = with_fixed(covariance(J, variance, scales), J, J_fixed, task.fixed_covariance, scales);
  set_intervals(result);
  note_bounds(fit, unknowns, result);
}

// All series weighed alike.
LeastSquaresFit first_fit(const GreyBoxTask& task, Misfit& misfit, const Residuals& residuals,
                          int& iterations) {
  // Where weights follow, only those depend on it.
  const LeastSquaresOptions options = misfit.series() > 1
                                          ? LeastSquaresOptions{.tolerance = 1e-8, .most_evaluations = 200}
                                          : LeastSquaresOptions{};
  if (!task.grow) return least_squares(misfit.unknowns(), residuals, options);
  LeastSquaresFit best;
  for (const double periods : kFirstPeriods) {
    std::vector<Unknown> unknowns = misfit.unknowns();
    grow(misfit, periods, unknowns, residuals, iterations);
    LeastSquaresFit fit = least_squares(unknowns, residuals, options);
    iterations += fit.iterations;
    const bool better = fit.converged > best.converged ||
                        (fit.converged == best.converged && fit.sum_of_squares() < best.sum_of_squares());
    if (best.p.size() == 0 || better) best = std::move(fit);
    const double missed = std::sqrt(best.sum_of_squares() / static_cast<double>(misfit.series()));
    if (best.converged && missed < kNowhere) break;
  }
  return best;
}

}  // namespace

Identification grey_box(const GreyBoxTask& task) {
  Misfit misfit(task);
  const Residuals residuals = [&](const VectorXd& p, VectorXd& r, MatrixXd* by) { return misfit(p, r, by); };
  Identification result;
  VectorXd r;
  if (!misfit.evaluate(misfit.start(), r, nullptr, nullptr)) {
    result.failure = "the model cannot be simulated where the fit starts: " + misfit.reason();
    return result;
  }
  LeastSquaresFit fit = first_fit(task, misfit, residuals, result.iterations);
  if (fit.converged && misfit.series() > 1) {
    misfit.weigh_by_residuals(fit.p);
    std::vector<Unknown> unknowns = misfit.unknowns();
    start_at(fit.p, unknowns);
    fit = least_squares(unknowns, residuals);
    result.iterations += fit.iterations;
  }
  result.converged = fit.converged;
  if (!fit.converged) {
    const std::string what = "the fit found no least sum of squares: " + fit.reason;
    if (fit.jacobian.size() == 0) {
      result.failure = what;
      return result;
    }
    result.notes.push_back(what + "; these are the best values met");
  }
  estimate(task, misfit, fit, result);
  result.records = misfit.fitted(fit.p);
  return result;
}

}  // namespace frahm::identification
