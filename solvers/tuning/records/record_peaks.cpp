#include "solvers/tuning/records/record_peaks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solvers/algebra/no_value.hpp"
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

}  // namespace

DesignPeaks peaks_of(const RecordTask& task, std::span<const double> design,
                     const std::function<bool()>& stop_asked) {
  // Energies are not followed where only a peak is asked for.
  static constexpr transient::MotionQuantity kPeak{transient::MotionMeasure::peak, 0};
  DesignPeaks peaks;
  std::vector<double> largest;
  mechanics::NetworkValues values;
  for (std::size_t s = 0; s < task.scenarios.size(); ++s) {
    task.network_at(s, design, values, nullptr);
    for (std::size_t r = 0; r < task.records.size(); ++r) {
      if (stop_asked()) return peaks;
      const transient::ForcedMotion motion =
          transient::forced_motion(task.network, [&](double) { return values; }, {},
                                   {.from = values.omega,
                                    .records = task.records[r],
                                    .duration = task.duration,
                                    .quantities = std::span(&kPeak, 1),
                                    .extrema = true});
      if (!motion.failure.empty()) {
        peaks.failure = motion.failure;
        return peaks;
      }
      peaks.motions.push_back(peaks_of_motion(motion, task.coordinate, s, r));
      largest.push_back(peaks.motions.back().front().value);
    }
  }
  peaks.objective = objective_of(task.objective, largest);
  return peaks;
}

double objective_of(RecordObjective objective, std::span<const double> peaks) {
  if (objective == RecordObjective::worst_peak) return *std::ranges::max_element(peaks);
  return std::accumulate(peaks.begin(), peaks.end(), 0.0) / static_cast<double>(peaks.size());
}

}  // namespace frahm::tuning
