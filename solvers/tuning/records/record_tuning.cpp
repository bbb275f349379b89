#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/tuning/records/record_exchange.hpp"
#include "solvers/tuning/records/record_task.hpp"
#include "solvers/tuning/stages/starts.hpp"

namespace frahm::tuning {
namespace {

void check(const RecordTask& task) {
  const auto refuse = [](const std::string& what) { throw mechanics::MechanicsError(what); };
  if (task.parameters.empty()) refuse("a tuning needs a design parameter");
  if (task.scenarios.empty()) refuse("a tuning needs a scenario");
  if (task.records.empty()) refuse("a tuning over records needs a record");
  if (!(task.duration > 0.0)) refuse("a tuning over records needs a duration above 0");
  if (!(task.goal.share > 0.0 && task.goal.share <= 1.0))
    refuse("a quantile belongs to a share above 0 and up to 1");
  if (task.goal.share < 1.0 && task.goal.objective != RecordObjective::worst_peak)
    refuse("a quantile belongs to the worst peaks");
  for (const DesignParameter& each : task.parameters) {
    if (each.schedule)
      refuse("parameter '" + each.name + "': a schedule runs over a band, but there is no band");
    if (!(each.lower <= each.upper)) refuse("parameter '" + each.name + "': its bounds must not be reversed");
  }
}

std::vector<double> start_design(const RecordTask& task, std::size_t start) {
  std::vector<Variable> box;
  for (const DesignParameter& each : task.parameters)
    box.push_back({.name = each.name, .lower = each.lower, .upper = each.upper, .start = each.nominal});
  return start_point(box, start);
}

}  // namespace

Optimum tune_over_records(const RecordTask& task, std::size_t start,
                          const std::function<bool()>& stop_asked) {
  check(task);
  return RecordExchange(task, stop_asked).run(start_design(task, start));
}

std::vector<Peak> largest_peaks(const RecordTask& task, std::span<const double> design) {
  const DesignPeaks found = peaks_of(
      task, design, [] { return false; }, Weighed::yes);
  std::vector<Peak> peaks;
  for (const auto& motion : found.motions) {
    const FoundPeak& largest = motion.front();
    peaks.push_back({.scenario = largest.place.scenario,
                     .record = largest.place.record,
                     .at = largest.place.time,
                     .value = largest.value,
                     .multiplier = kNone,
                     .sensitivity = {}});
  }
  return peaks;
}

}  // namespace frahm::tuning
