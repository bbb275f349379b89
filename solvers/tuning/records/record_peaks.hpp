#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "solvers/tuning/records/record_task.hpp"

namespace frahm::tuning {

// A time at which a motion's displacement is looked at.
struct PeakPlace {
  std::size_t scenario = 0, record = 0;
  double time = 0.0;  // [s]
  double sign = 1.0;  // of the displacement there
};

struct FoundPeak {
  PeakPlace place;
  double value = 0.0;  // the size of the displacement [m]
};

// All local peaks of a design: of each motion the turning points and the end. The first of each motion is
// its largest.
struct DesignPeaks {
  std::vector<std::vector<FoundPeak>> motions;  // of each scenario, and in it of each record
  std::string failure;                          // why a motion could not be followed
  double objective = 0.0;                       // the task's
  std::vector<bool> above;                      // of each scenario: the share leaves it out
};

// Whether a motion whose energies do not balance fails: an exchange looks at many designs, and weighs the one
// that it reports.
enum class Weighed { no, yes };

DesignPeaks peaks_of(const RecordTask& task, std::span<const double> design,
                     const std::function<bool()>& stop_asked, Weighed weighed);

// The worst of the peaks, or their mean.
double objective_of(RecordObjective objective, std::span<const double> peaks);

// For each scenario the largest peak of its records.
std::vector<double> worst_of_scenarios(const DesignPeaks& peaks, std::size_t scenarios);

}  // namespace frahm::tuning
