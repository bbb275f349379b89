#include "studies/tuning/tuning_result.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "studies/tuning/tuned_design.hpp"
#include "studies/tuning/tuning_task.hpp"

namespace frahm::studies {
namespace {

using tuning::Optimum, tuning::Outcome;

double or_worst(double value) {
  return std::isnan(value) ? kInfinity : value;
}

// Less is better.
std::tuple<int, double, double> rank(const Optimum& optimum) {
  const double violation = optimum.outcome == Outcome::infeasible ? or_worst(optimum.violation) : 0.0;
  return {static_cast<int>(optimum.outcome), violation, or_worst(optimum.objective)};
}

std::vector<tuning::Peak> peaks_before(const Study& study) {
  if (!study.tune()->peaks) return {};
  std::vector<double> design;
  for (const DesignChoice& choice : study.tune()->designs)
    design.push_back(study.parameters.nominal()[choice.parameter]);
  return tuning::largest_peaks(record_task(study), design);
}

// Over records: the objective of any design is true, whether the conditions of an optimum hold or not.
std::size_t least_of(const std::vector<const Optimum*>& optima) {
  const auto objective = [](const Optimum* optimum) { return or_worst(optimum->objective); };
  return static_cast<std::size_t>(std::ranges::min_element(optima, {}, objective) - optima.begin());
}

tuning::Assessment assess(const Study& study, const Optimum& optimum,
                          const std::function<bool()>& stop_asked) {
  if (study.tune()->peaks || !has_design(study, optimum)) return {};
  try {
    return tuning::assess(tuning_task(study), optimum, rules_of(study), stop_asked);
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", study.source.name + ": " + error.what());
  }
}

}  // namespace

std::size_t best_of(const std::vector<const Optimum*>& optima) {
  const auto best = std::min_element(optima.begin(), optima.end(),
                                     [](const Optimum* a, const Optimum* b) { return rank(*a) < rank(*b); });
  return static_cast<std::size_t>(best - optima.begin());
}

bool is_dominated(const TuningResult& result, std::size_t limit) {
  constexpr double equal = 1e-6;
  const Optimum& point = result.optimum(limit);
  for (std::size_t i = 0; i < result.limits(); ++i) {
    const Optimum& other = result.optimum(i);
    const bool is_lower = other.trade_off < point.trade_off && other.outcome != Outcome::infeasible;
    if (is_lower && other.objective <= point.objective * (1.0 + equal)) return true;
  }
  return false;
}

bool has_design(const Study& study, const Optimum& optimum) {
  const auto& designs = study.tune()->designs;
  if (optimum.parameters.size() != designs.size()) return false;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    if (optimum.parameters[i].value.size() != designs[i].count()) return false;
  }
  return true;
}

TuningResult tuning_result(const Study& study, std::vector<StartResult> starts,
                           const std::function<bool()>& stop_asked) {
  TuningResult result{
      .starts = std::move(starts), .best = {}, .assessment = {}, .before = peaks_before(study)};
  std::size_t limits = std::numeric_limits<std::size_t>::max();
  for (const StartResult& start : result.starts) limits = std::min(limits, start.optima.size());
  for (std::size_t limit = 0; limit < limits; ++limit) {
    std::vector<const Optimum*> optima;
    for (const StartResult& start : result.starts) optima.push_back(&start.optima[limit]);
    result.best.push_back(study.tune()->peaks ? least_of(optima) : best_of(optima));
  }
  result.assessment = assess(study, result.optimum(), stop_asked);
  return result;
}

}  // namespace frahm::studies
