#include "solvers/tuning/records/record_problem.hpp"

#include <algorithm>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/transient/displacement_sensitivity.hpp"

namespace frahm::tuning {

RecordProblem::RecordProblem(const RecordTask& task, const std::vector<PeakPlace>& active,
                             const std::function<bool()>& stop_asked, std::span<const double> start,
                             std::span<const double> peaks)
    : task_(task), active_(active), stop_asked_(stop_asked) {
  for (std::size_t p = 0; p < task.parameters.size(); ++p) {
    const DesignParameter& parameter = task.parameters[p];
    const double range = parameter.upper - parameter.lower;
    variables.push_back({.name = parameter.name,
                         .lower = parameter.lower,
                         .upper = parameter.upper,
                         .start = start[p],
                         .scale = range > 0.0 ? range : 1.0});
  }
  const double size = objective_of(task.goal.objective, peaks);
  objective_scale = size > 0.0 ? size : 1.0;
  if (task.goal.objective == RecordObjective::worst_peak) {
    variables.push_back({.name = "worst", .lower = 0.0, .start = size, .scale = objective_scale});
  } else {
    for (const double peak : peaks)
      variables.push_back({.name = "peak", .lower = 0.0, .start = peak, .scale = objective_scale});
  }
  add_rows();
}

void RecordProblem::add_rows() {
  for (const PeakPlace& place : active_) {
    const std::size_t row = constraints.size();
    constraints.push_back({.name = "peak", .upper = 0.0, .scale = objective_scale});
    for (std::size_t p = 0; p < task_.parameters.size(); ++p) jacobian.push_back({row, p});
    jacobian.push_back({row, bound_of(place)});
  }
}

double RecordProblem::objective(std::span<const double> x, std::span<double> gradient) {
  const std::size_t first = task_.parameters.size();
  const double share = 1.0 / static_cast<double>(bounds());
  double sum = 0.0;
  for (std::size_t i = first; i < x.size(); ++i) sum += share * x[i];
  std::fill(gradient.begin(), gradient.end(), 0.0);
  if (!gradient.empty())
    std::fill(gradient.begin() + static_cast<std::ptrdiff_t>(first), gradient.end(), share);
  return sum;
}

void RecordProblem::constrain(std::span<const double> x, std::span<double> values,
                              std::span<double> entries) {
  go_to(x.first(task_.parameters.size()));
  std::size_t entry = 0;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    values[i] = sizes_[i] - x[bound_of(active_[i])];
    if (entries.empty()) continue;
    for (const double slope : by_[i]) entries[entry++] = slope;
    entries[entry++] = -1.0;
  }
}

// Derivatives cost little compared with the motion, and are nearly always asked for next.
void RecordProblem::go_to(std::span<const double> design) {
  if (std::ranges::equal(design, design_)) return;
  design_.assign(design.begin(), design.end());
  sizes_.assign(active_.size(), kNone);
  by_.assign(active_.size(), std::vector<double>(design.size(), kNone));
  why_none_.clear();
  mechanics::NetworkValues values;
  std::vector<mechanics::NetworkValues> along;
  for (std::size_t s = 0; s < task_.scenarios.size(); ++s) {
    try {
      task_.network_at(s, design, values, &along);
      along.resize(design.size());
      for (std::size_t r = 0; r < task_.records.size(); ++r) follow(s, r, values, along);
    } catch (const mechanics::MechanicsError&) {
      continue;  // a value out of range: the step is taken back
    }
  }
}

// The rows of one motion, at their times.
void RecordProblem::follow(std::size_t scenario, std::size_t record, const mechanics::NetworkValues& values,
                           const std::vector<mechanics::NetworkValues>& along) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    if (active_[i].scenario == scenario && active_[i].record == record) rows.push_back(i);
  }
  if (rows.empty()) return;
  std::ranges::sort(rows, {}, [&](std::size_t i) { return active_[i].time; });
  std::vector<double> times;
  for (const std::size_t i : rows) times.push_back(active_[i].time);
  ++gradients_;
  const transient::DisplacementSensitivity motion = transient::displacement_sensitivity(
      task_.network, values, along, task_.records[record], task_.coordinate, times, {});
  if (!motion.failure.empty()) return;
  if (!motion.why_none.empty()) why_none_ = motion.why_none;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double sign = active_[rows[k]].sign;
    sizes_[rows[k]] = sign * motion.displacement[row];
    for (std::size_t p = 0; p < along.size() && motion.why_none.empty(); ++p)
      by_[rows[k]][p] = sign * motion.by(row, static_cast<Eigen::Index>(p));
  }
}

}  // namespace frahm::tuning
