#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/tuning/optimum.hpp"
#include "solvers/tuning/stages/design_tuning.hpp"
#include "solvers/tuning/stages/optimum_report.hpp"
#include "solvers/tuning/stages/start_design.hpp"

namespace frahm::tuning {
namespace {

void check(const Task& task) {
  const auto refuse = [](const std::string& what) { throw mechanics::MechanicsError(what); };
  if (task.parameters.empty()) refuse("a tuning needs a design parameter");
  if (task.scenarios.empty()) refuse("a tuning needs a scenario");
  if (!(task.band.from <= task.band.to)) refuse("the band must not be reversed");
  const bool has_schedule = std::any_of(task.parameters.begin(), task.parameters.end(),
                                        [](const DesignParameter& p) { return p.schedule.has_value(); });
  if (has_schedule && task.objective == Objective::variance)
    refuse("a schedule over the frequency has no meaning under white noise");
  if (task.dominate_constant && !has_schedule) refuse("only a schedule can dominate the best constant");
}

}  // namespace

std::vector<Optimum> tune(const Task& task, std::size_t start, const std::function<bool()>& stop_asked) {
  check(task);
  std::vector<Optimum> optima;
  std::vector<double> value;
  const std::size_t problems = task.trade_off ? task.trade_off->limits.size() : 1;
  for (std::size_t i = 0; i < problems; ++i) {
    std::vector<QuantityLimit> limits = task.limits;
    if (task.trade_off)
      limits.push_back(
          {task.trade_off->name, task.trade_off->quantity, -kInfinity, task.trade_off->limits[i], {}});
    Effort effort;
    DesignTuning tuning(task, limits, effort, stop_asked);
    if (value.empty()) {
      value = start_design(tuning.constant_space(), start);
      if (task.start == Start::global)
        value = global_design(
            task, tuning.constant_space(), [&](std::span<const double> x) { return tuning.worst_of(x); },
            stop_asked);
    }
    const Stages stages = tuning.from(value);
    Optimum optimum = report_optimum(task, tuning, stages, effort);
    optimum.trade_off = task.trade_off ? task.trade_off->limits[i] : kNone;
    optimum.orbits = effort.orbits;
    optimum.gradients = effort.gradients;
    // The next problem starts from this optimum: its constants, the middle knots of its schedules.
    if (stages.best.has_step) {
      for (std::size_t p = 0; p < value.size(); ++p) {
        const std::vector<double>& tuned = optimum.parameters[p].value;
        value[p] = tuned[tuned.size() / 2];
      }
    }
    optima.push_back(std::move(optimum));
    if (optima.back().outcome == Outcome::stopped) break;
  }
  return optima;
}

}  // namespace frahm::tuning
