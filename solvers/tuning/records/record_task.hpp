#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/transient/record.hpp"
#include "solvers/tuning/optimum.hpp"
#include "solvers/tuning/task.hpp"

// Tuning over records: the peak of a mass's or signal's displacement in motions from rest.
namespace frahm::tuning {

enum class RecordObjective {
  worst_peak,  // least worst of the peaks of all records and scenarios
  mean_peak,   // least mean of them
};

// What is minimised of the peaks.
struct PeakGoal {
  RecordObjective objective = RecordObjective::worst_peak;
  // For worst_peak: the share of the scenarios, each with the worst of its records, that counts; the others
  // are those with the largest peaks. Below 1 the objective is a quantile of the scenarios' peaks: the least
  // number that as many of them as this share do not exceed (order statistic ceil(share n)).
  double share = 1.0;  // > 0
};

struct RecordTask {
  mechanics::Network network;
  NetworkAt network_at;                     // `at` are the design parameters alone
  std::vector<std::string> scenarios;       // names, at least one
  std::vector<DesignParameter> parameters;  // at least one; no schedules
  // What drives each motion, at least one; the records must outlive the task.
  std::vector<std::vector<transient::RecordedExcitation>> records;
  double duration = 0.0;       // of each motion [s], > 0
  std::size_t coordinate = 0;  // the mass or signal (mechanics/coordinates.hpp)
  PeakGoal goal;

  SolverKind solver = SolverKind::slsqp;  // a local one
  double tolerance = 1e-6;                // of the certificate gap, relative
  int most_rounds = 60;
};

// Solves the task from one of its starts (stages/starts.hpp): 0 is the nominal design, the others fill the
// bounds. Of the optimum, `peaks` are the largest of each scenario and record, ascending in scenario, then
// record; certificate_gap is what no time that the solver saw has shown; orbits are motions, gradients
// motions with their derivatives. The result depends on the task and the start alone. Does not throw for
// numerical failures; throws mechanics::MechanicsError for a task without meaning.
Optimum tune_over_records(const RecordTask& task, std::size_t start, const std::function<bool()>& stop_asked);

// The largest peak of each scenario and record at a design, ascending in scenario, then record; without
// multipliers and sensitivities; fewer if a motion cannot be computed.
std::vector<Peak> largest_peaks(const RecordTask& task, std::span<const double> design);

}  // namespace frahm::tuning
