#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/tuning/optimum.hpp"
#include "solvers/tuning/stages/design_tuning.hpp"
#include "solvers/tuning/stages/front.hpp"
#include "solvers/tuning/stages/leap_place.hpp"
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

// The lowest places of the map after the optimum of the problem before, if there is one; where the map has
// none, the given design. Low places elsewhere follow: two for certain where three parameters make the cells
// coarse, the others while no start has converged.
Starts starts_of_map(DesignTuning& tuning, const std::vector<double>& before,
                     const std::vector<double>& given, DesignsSeen& seen) {
  constexpr std::size_t kPolished = 4;
  constexpr int kCoarse = 7;  // cells along a parameter
  const DesignMap map = tuning.map();
  seen.cells = map.merit.size();
  seen.share = seen.cells > 0 ? static_cast<double>(map.seen()) / static_cast<double>(seen.cells) : 0.0;
  Starts starts{.designs = lowest_places(map, kPolished), .sure = 0};
  const std::size_t more = kPolished - starts.designs.size();
  if (!before.empty()) starts.designs.insert(starts.designs.begin(), before);
  if (starts.designs.empty()) starts.designs.push_back(given);
  starts.sure = starts.designs.size() + (map.along <= kCoarse ? 2 : 0);
  for (const std::vector<double>& design : low_places_elsewhere(map, more)) starts.designs.push_back(design);
  return starts;
}

// One start's problems: the task, or the task under each limit of its trade-off.
class Problems {
 public:
  Problems(const Task& task, std::size_t start, const std::function<bool()>& stop_asked)
      : task_(task), start_(start), stop_asked_(stop_asked) {}

  // before: the constants of the optimum before, the middle knots of schedules; empty: the start's own.
  Optimum solve(std::size_t problem, const std::vector<double>& before) const {
    // 1. Where to begin.
    const std::vector<QuantityLimit> limits = limits_of(problem);
    Effort effort;
    DesignTuning constants(task_, limits, effort, stop_asked_);
    DesignsSeen seen;
    Starts begin{.designs = {before.empty() ? own_start(constants) : before}, .sure = 1};
    if (task_.start == Start::map) begin = starts_of_map(constants, before, begin.designs.front(), seen);
    // 2. The place of a leap, with the knots on both sides of it.
    const LeapDecided leap = may_leap(task_)
                                 ? decide_leap(task_, limits, begin.designs.front(), effort, stop_asked_)
                                 : LeapDecided{task_, {}};
    // 3. The designs.
    DesignTuning tuning(leap.task, limits, effort, stop_asked_);
    Stages stages = tuning.from(begin, leap.x);
    // 4. Where the start has no response, nor a design towards the middle of the box, the map's low places.
    const bool has_none = stages.best.outcome == Outcome::unbounded || stages.best.outcome == Outcome::failed;
    if (has_none && !stages.best.has_step && task_.start == Start::given && may_be_mapped(task_)) {
      begin = starts_of_map(constants, {}, begin.designs.front(), seen);
      stages = tuning.from(begin, leap.x);
    }
    Optimum optimum = report_optimum(leap.task, tuning, stages, effort);
    if (seen.cells > 0) seen.polished = stages.polished;
    optimum.seen = std::move(seen);
    optimum.trade_off = task_.trade_off ? task_.trade_off->limits[problem] : kNone;
    optimum.orbits = effort.orbits;
    optimum.gradients = effort.gradients;
    return optimum;
  }

 private:
  std::vector<QuantityLimit> limits_of(std::size_t problem) const {
    std::vector<QuantityLimit> limits = task_.limits;
    if (const auto& trade_off = task_.trade_off)
      limits.push_back({trade_off->name, trade_off->quantity, -kInfinity, trade_off->limits[problem], {}});
    return limits;
  }

  std::vector<double> own_start(DesignTuning& tuning) const {
    if (task_.start != Start::global) return start_design(tuning.constant_space(), start_);
    return global_design(
        task_, tuning.constant_space(), [&](std::span<const double> x) { return tuning.worst_of(x); },
        stop_asked_);
  }

  const Task& task_;
  const std::size_t start_;
  const std::function<bool()>& stop_asked_;
};

std::vector<double> constants_of(const Optimum& optimum) {
  std::vector<double> value;
  for (const TunedParameter& parameter : optimum.parameters)
    value.push_back(parameter.value[parameter.value.size() / 2]);
  return value;
}

bool has_response(const Optimum& optimum) {
  return !std::isnan(optimum.objective);
}

// Solves again, from the better design, what another problem's optimum undercuts.
void mend_front(const Problems& problems, std::vector<Optimum>& optima) {
  for (const auto& [problem, by] : undercut(optima)) {
    Optimum again = problems.solve(problem, constants_of(optima[by]));
    if (again.outcome == Outcome::stopped) return;
    again.orbits += optima[problem].orbits;
    again.gradients += optima[problem].gradients;
    const bool is_better =
        again.outcome != Outcome::infeasible &&
        (optima[problem].outcome == Outcome::infeasible || again.objective < optima[problem].objective);
    if (is_better) optima[problem] = std::move(again);
  }
}

}  // namespace

std::vector<Optimum> tune(const Task& task, std::size_t start, const std::function<bool()>& stop_asked) {
  check(task);
  const Problems problems(task, start, stop_asked);
  std::vector<Optimum> optima;
  std::vector<double> before;  // the design that the next problem starts from
  for (std::size_t i = 0; i < (task.trade_off ? task.trade_off->limits.size() : 1); ++i) {
    optima.push_back(problems.solve(i, before));
    if (optima.back().outcome == Outcome::stopped) return optima;
    if (has_response(optima.back())) before = constants_of(optima.back());
  }
  if (!task.trade_off) return optima;
  mend_front(problems, optima);
  optima.back().ends = front_ends(task, start, stop_asked);
  return optima;
}

}  // namespace frahm::tuning
