#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/tuning/problem/convergence.hpp"
#include "solvers/tuning/problem/solver.hpp"
#include "solvers/tuning/records/record_problem.hpp"
#include "solvers/tuning/records/record_task.hpp"
#include "solvers/tuning/stages/starts.hpp"

namespace frahm::tuning {
namespace {

constexpr double kHighPeaks = 0.7;  // peaks lower than this share of what counts are left out
constexpr double kSameTime = 1e-8;  // of the duration
constexpr double kClosed = 1e-9;    // the gap below which nothing more can be gained
constexpr double kSolved = 1e-5;    // a KKT residual that is still an optimum's
constexpr SolverOptions kRound{.tolerance = 1e-9, .most_iterations = 100};

void check(const RecordTask& task) {
  const auto refuse = [](const std::string& what) { throw mechanics::MechanicsError(what); };
  if (task.parameters.empty()) refuse("a tuning needs a design parameter");
  if (task.scenarios.empty()) refuse("a tuning needs a scenario");
  if (task.records.empty()) refuse("a tuning over records needs a record");
  if (!(task.duration > 0.0)) refuse("a tuning over records needs a duration above 0");
  for (const DesignParameter& each : task.parameters) {
    if (each.schedule)
      refuse("parameter '" + each.name + "': a schedule runs over a band, and there is none");
    if (!(each.lower <= each.upper)) refuse("parameter '" + each.name + "': its bounds must not be reversed");
  }
}

std::vector<double> start_design(const RecordTask& task, std::size_t start) {
  std::vector<Variable> box;
  for (const DesignParameter& each : task.parameters)
    box.push_back({.name = each.name, .lower = each.lower, .upper = each.upper, .start = each.nominal});
  return start_point(box, start);
}

std::vector<double> largest_of(const DesignPeaks& peaks) {
  std::vector<double> largest;
  for (const auto& motion : peaks.motions) largest.push_back(motion.front().value);
  return largest;
}

// The exchange: a problem at finitely many times solved, then the true peaks of its design found, which join
// these times, until the two agree (Remez; tuning/exchange/exchange.hpp).
class RecordExchange {
 public:
  RecordExchange(const RecordTask& task, const std::function<bool()>& stop_asked)
      : task_(task), stop_asked_(stop_asked), convergence_(task.tolerance, kClosed) {}

  Optimum run(std::vector<double> design) {
    DesignPeaks found = look(design);
    take(design, found);
    for (int round = 0; round < task_.most_rounds && found.failure.empty() && !stop_asked_(); ++round) {
      if (found.objective == 0.0) break;  // nothing can be less
      join(found);
      const std::vector<PeakPlace> active = active_;
      RecordProblem problem(task_, active, stop_asked_, design, largest_of(found));
      Solution solution = solve(problem, task_.solver, kRound);
      optimum_.gradients += problem.gradients();
      optimum_.iterations += solution.iterations;
      design.assign(solution.x.begin(), solution.x.begin() + static_cast<std::ptrdiff_t>(design.size()));
      found = look(design);
      if (stop_asked_() || !found.failure.empty()) break;
      optimum_.rounds.push_back({.active = active.size(),
                                 .iterations = solution.iterations,
                                 .bound = solution.objective,
                                 .worst = found.objective,
                                 .violation = 0.0,
                                 .solver = task_.solver});
      const double gap = (found.objective - solution.objective) / found.objective;
      const bool is_last = convergence_.judge(gap, 0.0, solution.ending == Ending::converged);
      if (found.objective <= best_.objective || (is_last && convergence_.met())) {
        take(design, found);
        solution_ = std::move(solution);
        solved_ = active;
      }
      if (is_last) break;
    }
    return written(found.failure);
  }

 private:
  DesignPeaks look(const std::vector<double>& design) {
    DesignPeaks found = peaks_of(task_, design, stop_asked_);
    optimum_.orbits += found.motions.size();
    return found;
  }

  void take(const std::vector<double>& design, const DesignPeaks& found) {
    design_ = design;
    best_ = found;
  }

  // The high peaks become active times, each once.
  void join(const DesignPeaks& found) {
    for (const auto& motion : found.motions) {
      const bool worst = task_.objective == RecordObjective::worst_peak;
      const double counts = worst ? found.objective : motion.front().value;
      for (const FoundPeak& peak : motion) {
        if (peak.value < kHighPeaks * counts) continue;
        const bool known = std::ranges::any_of(active_, [&](const PeakPlace& other) {
          return other.scenario == peak.place.scenario && other.record == peak.place.record &&
                 other.sign == peak.place.sign &&
                 std::abs(other.time - peak.place.time) <= kSameTime * task_.duration;
        });
        if (!known) active_.push_back(peak.place);
      }
    }
  }

  Optimum written(const std::string& failure) {
    judge(failure);
    const bool known = optimum_.outcome == Outcome::converged;
    write_parameters(known);
    if (best_.motions.empty() || !best_.failure.empty()) return optimum_;
    optimum_.objective = best_.objective;
    write_peaks(known);
    return optimum_;
  }

  void judge(const std::string& failure) {
    optimum_.objective = optimum_.certificate_gap = optimum_.kkt_residual = kNone;
    optimum_.constant_objective = optimum_.trade_off = kNone;
    if (stop_asked_()) {
      end(Outcome::stopped, "stopped before the end");
    } else if (!failure.empty()) {
      end(Outcome::failed, "a motion could not be computed: " + failure);
    } else if (best_.objective == 0.0) {
      optimum_.certificate_gap = optimum_.kkt_residual = 0.0;
      end(Outcome::converged, "nothing moves, and nothing can be less");
    } else if (solved_.empty()) {
      end(Outcome::not_converged, "no round found a better design than the start");
    } else {
      optimum_.certificate_gap = (best_.objective - solution_.objective) / best_.objective;
      optimum_.kkt_residual = solution_.kkt_residual;
      const bool solved = solution_.ending == Ending::converged || solution_.kkt_residual <= kSolved;
      if (std::abs(optimum_.certificate_gap) <= task_.tolerance && solved)
        end(Outcome::converged, "the certificate gap and the KKT residual are below their tolerances");
      else if (std::abs(optimum_.certificate_gap) <= task_.tolerance)
        end(Outcome::not_converged,
            "the certificate gap is closed, but the conditions of an optimum do not hold: where a contact "
            "just "
            "begins to slip a peak has a kink, which may hold the design");
      else
        end(Outcome::not_converged, "the rounds of exchange no longer close the gap: " + solution_.reason);
    }
  }

  void end(Outcome outcome, std::string reason) {
    optimum_.outcome = outcome;
    optimum_.reason = std::move(reason);
  }

  // Multipliers belong to bounds that are met.
  void write_parameters(bool known) {
    constexpr double kMet = 1e-5;  // of the range
    for (std::size_t p = 0; p < task_.parameters.size(); ++p) {
      const DesignParameter& parameter = task_.parameters[p];
      const double near = kMet * (parameter.upper - parameter.lower), x = design_[p];
      const AtBound at = x - parameter.lower <= near   ? AtBound::lower
                         : parameter.upper - x <= near ? AtBound::upper
                                                       : AtBound::no;
      const auto multiplier = [&](AtBound bound, const std::vector<double>& all) {
        return !known ? kNone : at == bound && p < all.size() ? all[p] : 0.0;
      };
      optimum_.parameters.push_back(
          {.value = {x},
           .at_bound = {at},
           .lower_multiplier = {multiplier(AtBound::lower, solution_.lower_multipliers)},
           .upper_multiplier = {multiplier(AtBound::upper, solution_.upper_multipliers)}});
    }
  }

  // The largest of each motion, with the multipliers of all its times.
  void write_peaks(bool known) {
    std::vector<PeakPlace> places;
    for (const auto& motion : best_.motions) places.push_back(motion.front().place);
    RecordProblem there(task_, places, stop_asked_, design_, largest_of(best_));
    std::vector<double> x = design_, values(places.size()), entries(there.jacobian.size());
    for (const Variable& each : std::span(there.variables).subspan(design_.size())) x.push_back(each.start);
    there.constrain(x, values, entries);
    optimum_.gradients += there.gradients();
    for (std::size_t m = 0; m < places.size(); ++m) {
      const auto first = entries.begin() + static_cast<std::ptrdiff_t>(m * (design_.size() + 1));
      Peak peak{.scenario = places[m].scenario,
                .record = places[m].record,
                .at = places[m].time,
                .value = best_.motions[m].front().value,
                .multiplier = known ? 0.0 : kNone,
                .sensitivity = {first, first + static_cast<std::ptrdiff_t>(design_.size())}};
      for (std::size_t i = 0; known && i < solved_.size(); ++i) {
        const bool own = solved_[i].scenario == peak.scenario && solved_[i].record == peak.record;
        if (own) peak.multiplier += std::max(0.0, solution_.constraint_multipliers[i]);
      }
      optimum_.peaks.push_back(std::move(peak));
    }
  }

  const RecordTask& task_;
  const std::function<bool()>& stop_asked_;
  Convergence convergence_;
  std::vector<PeakPlace> active_;
  std::vector<double> design_;     // the best
  DesignPeaks best_;               // of it
  Solution solution_;              // it is of
  std::vector<PeakPlace> solved_;  // the active times of that solution
  Optimum optimum_;
};

}  // namespace

Optimum tune_over_records(const RecordTask& task, std::size_t start,
                          const std::function<bool()>& stop_asked) {
  check(task);
  return RecordExchange(task, stop_asked).run(start_design(task, start));
}

std::vector<Peak> largest_peaks(const RecordTask& task, std::span<const double> design) {
  const DesignPeaks found = peaks_of(task, design, [] { return false; });
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
