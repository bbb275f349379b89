#include "solvers/tuning/records/record_exchange.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/problem/convergence.hpp"
#include "solvers/tuning/problem/solver.hpp"
#include "solvers/tuning/records/record_problem.hpp"

namespace frahm::tuning {
namespace {

constexpr double kHighPeaks = 0.7;   // peaks lower than this share of what counts are left out
constexpr double kHighOfMany = 0.9;  // of a quantile, whose many samples have one each
constexpr double kSameTime = 1e-8;   // of the duration
constexpr double kClosed = 1e-9;     // the gap below which nothing more can be gained
constexpr SolverOptions kRound{.tolerance = 1e-9, .most_iterations = 100};
constexpr int kMostChoices = 100;  // of scenarios left out: each but the last few lowers the objective

bool is_left_out(const std::vector<bool>& left_out, std::size_t scenario) {
  return !left_out.empty() && left_out[scenario];
}

// For the motions whose scenarios are kept.
std::vector<double> largest_of(const DesignPeaks& peaks, const std::vector<bool>& left_out) {
  std::vector<double> largest;
  for (const auto& motion : peaks.motions) {
    if (!is_left_out(left_out, motion.front().place.scenario)) largest.push_back(motion.front().value);
  }
  return largest;
}

}  // namespace

Optimum RecordExchange::run(std::vector<double> design) {
  best_.found = look(design);
  best_.design = std::move(design);
  left_out_ = best_.found.above;
  chosen_ = {left_out_};
  close_gap();
  for (int choice = 0; choice < kMostChoices && task_.goal.share < 1.0 && goes_on(); ++choice) {
    if (!choose_again() && !exchange_one()) break;
  }
  return written();
}

DesignPeaks RecordExchange::look(const std::vector<double>& design) {
  DesignPeaks found = peaks_of(task_, design, stop_asked_, Weighed::no);
  optimum_.orbits += found.motions.size();
  failure_ = found.failure;
  return found;
}

// The objective of the scenarios kept.
double RecordExchange::counted(const DesignPeaks& found) const {
  return objective_of(task_.goal.objective, largest_of(found, left_out_));
}

// The high peaks become active times, each once.
void RecordExchange::join(const DesignPeaks& found) {
  const double worst = counted(found), high = task_.goal.share < 1.0 ? kHighOfMany : kHighPeaks;
  for (const auto& motion : found.motions) {
    if (is_left_out(left_out_, motion.front().place.scenario)) continue;
    const double counts = task_.goal.objective == RecordObjective::worst_peak ? worst : motion.front().value;
    for (const FoundPeak& peak : motion) {
      if (peak.value < high * counts) continue;
      const bool known = std::ranges::any_of(active_, [&](const PeakPlace& other) {
        return other.scenario == peak.place.scenario && other.record == peak.place.record &&
               other.sign == peak.place.sign &&
               std::abs(other.time - peak.place.time) <= kSameTime * task_.duration;
      });
      if (!known) active_.push_back(peak.place);
    }
  }
}

std::vector<PeakPlace> RecordExchange::active_kept() const {
  std::vector<PeakPlace> kept;
  std::ranges::copy_if(active_, std::back_inserter(kept),
                       [&](const PeakPlace& place) { return !is_left_out(left_out_, place.scenario); });
  return kept;
}

// Presses down what counts of the scenarios kept, from the best design on.
void RecordExchange::close_gap() {
  Convergence convergence(task_.tolerance, kClosed);
  std::vector<double> design = best_.design;
  DesignPeaks found = best_.found;
  for (int round = 0; round < task_.most_rounds && goes_on(); ++round) {
    if (counted(found) == 0.0) break;  // nothing can be less
    join(found);
    const std::vector<PeakPlace> active = active_kept();
    RecordProblem problem(task_, active, stop_asked_, design, largest_of(found, left_out_));
    Solution solution = solve(problem, task_.solver, kRound);
    optimum_.gradients += problem.gradients();
    why_none_ = problem.why_no_derivative();
    optimum_.iterations += solution.iterations;
    design.assign(solution.x.begin(), solution.x.begin() + static_cast<std::ptrdiff_t>(design.size()));
    found = look(design);
    if (!goes_on()) break;
    const double worst = counted(found);
    optimum_.rounds.push_back({.active = active.size(),
                               .iterations = solution.iterations,
                               .bound = solution.objective,
                               .worst = worst,
                               .violation = 0.0,
                               .solver = task_.solver});
    const double gap = (worst - solution.objective) / worst;
    const bool is_last = convergence.judge(gap, 0.0, solution.ending == Ending::converged);
    if (worst <= counted(best_.found) || (is_last && convergence.met()))
      best_ = {design, found, std::move(solution), active};
    if (is_last) break;
  }
}

// Leaves out the scenarios that lie above now. False: these are the ones left out, or were before.
bool RecordExchange::choose_again() {
  if (std::ranges::find(chosen_, best_.found.above) != chosen_.end()) return false;
  left_out_ = best_.found.above;
  chosen_.push_back(left_out_);
  close_gap();
  return true;
}

// The scenarios whose peaks hold the design.
std::vector<std::size_t> RecordExchange::holding() const {
  constexpr double kHolds = 1e-6;
  std::vector<std::size_t> scenarios;
  for (std::size_t i = 0; i < best_.solved.size(); ++i) {
    const std::size_t scenario = best_.solved[i].scenario;
    if (best_.solution.constraint_multipliers[i] > kHolds &&
        std::ranges::find(scenarios, scenario) == scenarios.end())
      scenarios.push_back(scenario);
  }
  return scenarios;
}

// Leaves out one that holds the design, and keeps the lowest of those left out. False: none lowers Q.
bool RecordExchange::exchange_one() {
  const std::vector<double> worst = worst_of_scenarios(best_.found, task_.scenarios.size());
  std::size_t lowest = worst.size();
  for (std::size_t s = 0; s < worst.size(); ++s) {
    if (left_out_[s] && (lowest == worst.size() || worst[s] < worst[lowest])) lowest = s;
  }
  if (lowest == worst.size()) return false;
  for (const std::size_t scenario : holding()) {
    std::vector<bool> exchanged = left_out_;
    exchanged[lowest] = false;
    exchanged[scenario] = true;
    if (std::ranges::find(chosen_, exchanged) == chosen_.end() && lowers(std::move(exchanged))) return true;
  }
  return false;
}

// Whether the objective falls with others left out; if not, all is as before.
bool RecordExchange::lowers(std::vector<bool> left_out) {
  const Best before = best_;
  chosen_.push_back(left_out);
  std::swap(left_out_, left_out);
  close_gap();
  if (goes_on() && best_.found.objective < before.found.objective * (1.0 - task_.tolerance)) return true;
  best_ = before;
  left_out_ = std::move(left_out);
  failure_.clear();
  return false;
}

}  // namespace frahm::tuning
