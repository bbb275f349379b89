#include "solvers/identification/misfit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/rotation.hpp"

namespace frahm::identification {

using Eigen::Index;
using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

Eigen::Map<const VectorXd> measured(const Channel& channel, std::size_t samples) {
  return {channel.values.data(), static_cast<Index>(samples)};
}

constexpr std::size_t kSamplesAnUnknown = 4;  // of a record's beginning, at least
// Sensors without noise count this part of their variation as noise: rounding, and no more weight.
constexpr double kExact = 1e-10;
// A channel that moves by less than this share of the measured variation does not move.
constexpr double kStill = 1e-9;

// |y - mean y|
double spread(const Eigen::Ref<const VectorXd>& y) {
  return (y.array() - y.mean()).matrix().norm();
}

bool varies(const Channel& channel, std::size_t samples) {
  const auto y = measured(channel, samples);
  return spread(y) > kConstant * y.norm();
}

// |y - mean y|, of a series that does not vary |y|, or 1.
double variation(const Channel& channel) {
  const auto y = measured(channel, channel.values.size());
  if (varies(channel, channel.values.size())) return spread(y);
  return y.norm() > 0.0 ? y.norm() : 1.0;
}

int turns_of(const Eigen::Ref<const VectorXd>& y) {
  int count = 0;
  double way = 0.0;
  for (Index i = 1; i < y.size(); ++i) {
    const double step = y[i] - y[i - 1];
    if (step * way < 0.0) ++count;
    if (step != 0.0) way = step;
  }
  return count;
}

}  // namespace

Misfit::Misfit(const GreyBoxTask& task) : task_(task) {
  for (const TimeRecord& record : task.records) {
    simulations_.emplace_back(task.network, record, task.watch);
    horizon_.push_back(record.time.size());
    weights_.emplace_back();
    for (const Channel& channel : record.channels) weights_.back().push_back(1.0 / variation(channel));
  }
  for (std::size_t i = 0; i < task.parameters.size(); ++i) add_unknowns(i);
}

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

bool Misfit::operator()(const VectorXd& p, VectorXd& r, MatrixXd* by) {
  try {
    return evaluate(p, r, by, nullptr);
  } catch (const mechanics::MechanicsError& error) {
    reason_ = error.what();
    return false;
  }
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

bool Misfit::simulate(std::size_t record, const VectorXd& p, periodic::ObservedMotion& motion) {
  try {
    return simulations_[record].run(model(record, p, nullptr), {}, horizon_[record], motion).empty() &&
           motion.values.allFinite();
  } catch (const mechanics::MechanicsError&) {
    return false;
  }
}

bool Misfit::moves(const VectorXd& p) {
  periodic::ObservedMotion motion;
  bool some_vary = false;
  for (std::size_t record = 0; record < task_.records.size(); ++record) {
    if (!simulate(record, p, motion)) return false;
    for (std::size_t c = 0; c < weights_[record].size(); ++c) {
      const Channel& channel = task_.records[record].channels[c];
      if (!varies(channel, horizon_[record])) continue;
      some_vary = true;
      const double moved = spread(motion.values.col(static_cast<Index>(c)));
      if (moved > kStill * spread(measured(channel, horizon_[record]))) return true;
    }
  }
  return !some_vary;
}

int Misfit::turns(const VectorXd& p) {
  int most = 0;
  periodic::ObservedMotion motion;
  for (std::size_t record = 0; record < task_.records.size(); ++record) {
    if (!simulate(record, p, motion)) continue;
    for (const auto column : motion.values.colwise()) most = std::max(most, turns_of(column));
  }
  return most;
}

std::vector<Index> Misfit::frictions(const VectorXd& p) const {
  std::vector<bool> rubs(unknowns_.size(), false);
  std::vector<Model> by;
  for (std::size_t record = 0; record < task_.records.size(); ++record) {
    model(record, p, &by);
    for (std::size_t i = 0; i < task_.parameters.size(); ++i) {
      for (std::size_t e = 0; e < task_.network.elements.size(); ++e) {
        const bool moves = by[i].values.element[e] != 0.0 || mechanics::second_value(by[i].values, e) != 0.0;
        if (mechanics::has_contact(task_.network.elements[e]) && moves)
          rubs[static_cast<std::size_t>(place(record, i))] = true;
      }
    }
  }
  std::vector<Index> list;
  for (std::size_t u = 0; u < rubs.size(); ++u) {
    if (rubs[u]) list.push_back(static_cast<Index>(u));
  }
  return list;
}

std::vector<VectorXd> Misfit::without_static_forces(const VectorXd& p) const {
  std::vector<VectorXd> moved;
  std::vector<Model> by;
  for (std::size_t record = 0; record < task_.records.size(); ++record) {
    const Model at = model(record, p, &by);
    for (std::size_t i = 0; i < task_.parameters.size(); ++i) {
      for (std::size_t e = 0; e < task_.network.elements.size(); ++e) {
        const double rate = mechanics::second_value(by[i].values, e);
        if (!task_.network.elements[e].has_static_force || rate == 0.0 || by[i].values.element[e] != 0.0)
          continue;
        moved.push_back(p);
        moved.back()[place(record, i)] += (at.values.element[e] - at.values.second[e]) / rate;
      }
    }
  }
  return moved;
}

// A channel's residuals have as many degrees of freedom as samples, less those that the fit uses: the trace
// of the channel's part of the projection J (J^T J)^-1 J^T = Q Q^T.
double Misfit::weigh_by_residuals(const VectorXd& p) {
  VectorXd r;
  MatrixXd J;
  if (!(*this)(p, r, &J)) return 0.0;
  for (Index i = 0; i < J.cols(); ++i) J.col(i).normalize();
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(J);
  const MatrixXd Q = qr.householderQ() * MatrixXd::Identity(J.rows(), qr.rank());
  double least = kInfinity, largest = 0.0;
  Index row = 0;
  for (std::size_t record = 0; record < task_.records.size(); ++record) {
    const auto samples = static_cast<Index>(horizon_[record]);
    const double count = static_cast<double>(samples);
    for (std::size_t c = 0; c < weights_[record].size(); ++c, row += samples) {
      const double free = std::max(1.0, count - Q.middleRows(row, samples).squaredNorm());
      const double deviation = std::sqrt(r.segment(row, samples).squaredNorm() / free);
      const double exact = kExact * weights_[record][c] * variation(task_.records[record].channels[c]);
      const double factor = 1.0 / std::max(deviation, exact / std::sqrt(count));
      weights_[record][c] *= factor;
      least = std::min(least, factor);
      largest = std::max(largest, factor);
    }
  }
  return largest / least - 1.0;
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
      const std::string_view unit =
          mechanics::unit_of_mass(task_.network, channel.mass, kUnits[static_cast<int>(channel.signal)]);
      fit.series.push_back({channel.name, std::string(unit), channel.values,
                            std::vector<double>(column.begin(), column.end())});
    }
    fit.nrmse = nrmse(fit.series);
    list.push_back(std::move(fit));
  }
  return list;
}

}  // namespace frahm::identification
