#include "solvers/tuning/records/record_peaks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/transient/forced_motion.hpp"

namespace frahm::tuning {
namespace {

// The motion's largest first, then its turning points.
std::vector<FoundPeak> peaks_of_motion(const transient::ForcedMotion& motion, std::size_t coordinate,
                                       std::size_t scenario, std::size_t record) {
  std::vector<FoundPeak> found;
  const auto add = [&](const transient::Extremum& at) {
    const double x = at.displacement;
    found.push_back({{scenario, record, at.time, std::copysign(1.0, x)}, std::abs(x)});
  };
  add(motion.peaks[coordinate]);
  for (const transient::Extremum& each : motion.extrema[coordinate]) add(each);
  return found;
}

// Those with the largest peaks, as many as the share leaves out; of equal ones the last.
std::vector<bool> above_share(const std::vector<double>& worst, double share) {
  constexpr double kRounding = 1e-9;  // 0.95 * 20 is 19
  const auto n = static_cast<double>(worst.size());
  const auto kept = static_cast<std::size_t>(std::max(1.0, std::ceil(share * n - kRounding)));
  std::vector<std::size_t> order(worst.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t s) { return worst[s]; });
  std::vector<bool> above(worst.size(), false);
  for (std::size_t i = std::min(kept, order.size()); i < order.size(); ++i) above[order[i]] = true;
  return above;
}

// A motion of a scenario; one without a meaning is reported with the name of its scenario, where there are
// several.
transient::ForcedMotion motion_of(const RecordTask& task, std::size_t scenario, std::size_t record,
                                  const mechanics::NetworkValues& values, Weighed weighed) {
  static constexpr transient::MotionQuantity kPeak{transient::MotionMeasure::peak, 0};
  try {
    return transient::forced_motion(task.network, [&](double) { return values; }, {},
                                    {.from = values.omega,
                                     .records = task.records[record],
                                     .duration = task.duration,
                                     .quantities = std::span(&kPeak, 1),
                                     .extrema = true,
                                     .weighed = weighed == Weighed::yes});
  } catch (const mechanics::MechanicsError& error) {
    if (task.scenarios.size() < 2) throw;
    throw mechanics::MechanicsError(task.scenarios[scenario] + ": " + error.what());
  }
}

}  // namespace

DesignPeaks peaks_of(const RecordTask& task, std::span<const double> design,
                     const std::function<bool()>& stop_asked, Weighed weighed) {
  DesignPeaks peaks;
  std::vector<double> largest;
  mechanics::NetworkValues values;
  for (std::size_t s = 0; s < task.scenarios.size(); ++s) {
    task.network_at(s, design, values, nullptr);
    for (std::size_t r = 0; r < task.records.size(); ++r) {
      if (stop_asked()) return peaks;
      const transient::ForcedMotion motion = motion_of(task, s, r, values, weighed);
      if (!motion.failure.empty()) {
        peaks.failure = motion.failure;
        return peaks;
      }
      peaks.motions.push_back(peaks_of_motion(motion, task.coordinate, s, r));
      largest.push_back(peaks.motions.back().front().value);
    }
  }
  peaks.objective = objective_of(task.goal.objective, largest);
  if (task.goal.objective == RecordObjective::mean_peak) return peaks;
  const std::vector<double> worst = worst_of_scenarios(peaks, task.scenarios.size());
  peaks.above = above_share(worst, task.goal.share);
  peaks.objective = 0.0;
  for (std::size_t s = 0; s < worst.size(); ++s) {
    if (!peaks.above[s]) peaks.objective = std::max(peaks.objective, worst[s]);
  }
  return peaks;
}

double objective_of(RecordObjective objective, std::span<const double> peaks) {
  if (objective == RecordObjective::worst_peak) return *std::ranges::max_element(peaks);
  return std::accumulate(peaks.begin(), peaks.end(), 0.0) / static_cast<double>(peaks.size());
}

std::vector<double> worst_of_scenarios(const DesignPeaks& peaks, std::size_t scenarios) {
  std::vector<double> worst(scenarios, 0.0);
  for (const auto& motion : peaks.motions) {
    double& of = worst[motion.front().place.scenario];
    of = std::max(of, motion.front().value);
  }
  return worst;
}

}  // namespace frahm::tuning
