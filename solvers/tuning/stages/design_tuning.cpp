#include "solvers/tuning/stages/design_tuning.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/stages/path_search.hpp"

namespace frahm::tuning {
namespace {

// The last stage may raise the worst peak by this share of it, to have room to move in.
constexpr double kRoom = 1e-7;

std::vector<DesignParameter> without_schedules(std::vector<DesignParameter> parameters) {
  for (DesignParameter& parameter : parameters) parameter.schedule.reset();
  return parameters;
}

// The objective in each scenario, and each side of each limit in each scenario.
std::vector<CurveKind> curves_of(const Task& task, const std::vector<QuantityLimit>& limits) {
  using Of = CurveKind::Of;
  std::vector<CurveKind> curves;
  for (std::size_t s = 0; s < task.scenarios.size(); ++s) {
    if (task.objective != Objective::variance)
      curves.push_back({Of::objective, s, 0, task.quantity, task.band, 0.0, {}});
    for (std::size_t i = 0; i < limits.size(); ++i) {
      const QuantityLimit& limit = limits[i];
      const Band band = limit.band.value_or(task.band);
      if (std::isfinite(limit.upper))
        curves.push_back({Of::upper_limit, s, i, limit.quantity, band, limit.upper, {}});
      if (std::isfinite(limit.lower))
        curves.push_back({Of::lower_limit, s, i, limit.quantity, band, limit.lower, {}});
    }
  }
  return curves;
}

// The nearest values to x that the slope limit allows, by passes that pull neighbours together.
void respect_slopes(const DesignSpace& space, std::vector<double>& x) {
  for (std::size_t p = 0; p < space.parameters(); ++p) {
    const auto& schedule = space.parameter(p).schedule;
    if (!schedule || std::isinf(schedule->max_slope)) continue;
    const std::size_t first = space.first(p), last = first + space.count(p) - 1;
    const auto pull = [&](std::size_t knot, std::size_t towards) {
      const double gap = std::abs(schedule->knots[knot - first] - schedule->knots[towards - first]);
      const double most = schedule->max_slope * gap;
      x[knot] = std::clamp(x[knot], x[towards] - most, x[towards] + most);
    };
    for (std::size_t k = first + 1; k <= last; ++k) {
      if (schedule->leap != k - 1 - first) pull(k, k - 1);
    }
  }
}

}  // namespace

DesignTuning::DesignTuning(const Task& task, std::vector<QuantityLimit> limits, Effort& effort,
                           const std::function<bool()>& stop_asked)
    : task_(task),
      limits_(std::move(limits)),
      effort_(effort),
      stop_asked_(stop_asked),
      space_(task.parameters),
      constant_space_(without_schedules(task.parameters)),
      curves_(curves_of(task, limits_)) {}

Goal DesignTuning::goal() const {
  switch (task_.objective) {
    case Objective::mean_square:
      return {Goal::Of::mean_square};
    case Objective::variance:
      return {Goal::Of::variance};
    case Objective::minimax:
      break;
  }
  return {Goal::Of::worst};
}

Stages DesignTuning::from(const Starts& starts, const std::vector<double>& schedules) {
  Stages stages;
  const auto keep = [&](const Exchange::Result& result) {
    stages.best = result;
    stages.decisive = result.step;
    stages.bound = result.step.solution.objective;
    stages.rounds.insert(stages.rounds.end(), result.rounds.begin(), result.rounds.end());
  };
  // 1. The best constants.
  keep(best_constant(starts, stages));
  if (!space_.has_schedule()) return stages;
  stages.constant = stages.best;
  if (!stages.best.has_step) return stages;
  stages.constant_value = stages.best.x;
  // 2. From them the schedules.
  const Exchange::Result schedule = tune_schedule(stages.constant_value, schedules);
  keep(schedule);
  // 3. The knots that the worst peak leaves free.
  if (task_.objective == Objective::minimax && schedule.has_step) {
    const Scan& of_constant = stages.constant.scan;
    const bool constant_serves = of_constant.violation <= std::max(schedule.scan.violation, 1e-9) &&
                                 of_constant.worst <= schedule.scan.worst * (1.0 + 2.0 * kRoom);
    if (constant_serves) {
      stages.best.x = space_.constant_design(stages.constant_value);
      stages.best.scan = of_constant;
    } else {
      settle_free_knots(schedule.scan.worst * (1.0 + kRoom), stages);
    }
  }
  tell_bound(stages);
  return stages;
}

// Results with a design first, those that meet the limits before others; of equal objectives the converged
// one.
Exchange::Result DesignTuning::best_constant(const Starts& starts, Stages& stages) {
  constexpr double kEqual = 1e-6;
  const auto objective_of = [&](const Exchange::Result& result) {
    if (!result.has_step) return result.outcome == Outcome::converged ? 0.0 : kNone;
    return task_.objective == Objective::minimax ? result.scan.worst : result.step.objective_again;
  };
  const auto is_better = [&](const Exchange::Result& one, const Exchange::Result& other) {
    const double a = objective_of(one), b = objective_of(other);
    if (std::isnan(a) || std::isnan(b)) return std::isnan(b) && !std::isnan(a);
    const bool breaks = one.outcome == Outcome::infeasible,
               other_breaks = other.outcome == Outcome::infeasible;
    if (breaks != other_breaks) return other_breaks;
    const double violation = one.scan.violation, other_violation = other.scan.violation;
    const bool break_alike = std::abs(violation - other_violation) <= kEqual * (1.0 + other_violation);
    if (breaks && !break_alike) return violation < other_violation;
    const bool converges = one.outcome == Outcome::converged && other.outcome != Outcome::converged;
    return converges ? a < b * (1.0 + kEqual) : a < b * (1.0 - kEqual);
  };
  std::optional<Exchange::Result> best;
  for (std::size_t i = 0; i < starts.designs.size(); ++i) {
    if (i >= starts.sure && best->outcome == Outcome::converged) break;
    Exchange::Result result = tune_constant(starts.designs[i]);
    stages.polished.push_back(result.outcome == Outcome::infeasible ? kNone : objective_of(result));
    if (result.outcome == Outcome::stopped) return result;
    if (!best || is_better(result, *best)) best = std::move(result);
  }
  // What has not converged is tuned once more from where it ended, with new active frequencies.
  if (best->outcome == Outcome::not_converged) {
    Exchange::Result again = tune_constant(best->x);
    again.rounds.insert(again.rounds.begin(), best->rounds.begin(), best->rounds.end());
    if (again.outcome == Outcome::stopped || is_better(again, *best)) best = std::move(again);
  }
  return *best;
}

DesignMap DesignTuning::map() {
  SampledCurves sampled(task_, constant_space_, curves_, effort_, stop_asked_);
  Exchange exchange(task_, constant_space_, curves_, effort_, stop_asked_);
  const auto merit_at = [&](std::span<const double> value) {
    DesignMerit merit = sampled.at(value);
    if (task_.objective != Objective::minimax) merit.objective = exchange.integral(goal(), value);
    return merit;
  };
  return map_designs(constant_space_, merit_at, stop_asked_);
}

// A bound above the design found shows that the response has valleys that the grid does not.
void DesignTuning::tell_bound(Stages& stages) {
  if (!PathSearch::serves(task_) || !stages.best.has_step) return;
  const double bound = PathSearch(task_, limits_, effort_.orbits, stop_asked_).bound(stages.best.x);
  if (bound <= stages.best.scan.worst * (1.0 + kRoom)) stages.path_bound = bound;
}

Exchange::Result DesignTuning::schedules_from(const std::vector<double>& x) {
  return Exchange(task_, space_, curves_, effort_, stop_asked_).run(goal(), x);
}

Exchange::Result DesignTuning::tune_constant(const std::vector<double>& value) {
  Exchange exchange(task_, constant_space_, curves_, effort_, stop_asked_);
  // If a start has no response, or an unbounded one, it moves towards the middle of the box.
  std::optional<Exchange::Result> as_given;
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    std::vector<double> x = constant_space_.constant_design(value);
    for (std::size_t p = 0; p < x.size(); ++p) {
      const DesignParameter& parameter = constant_space_.parameter(p);
      x[p] += share * (0.5 * (parameter.lower + parameter.upper) - x[p]);
    }
    Exchange::Result result = exchange.run(goal(), x);
    if (result.has_step || result.outcome == Outcome::stopped || result.outcome == Outcome::converged)
      return result;
    if (!as_given) as_given = std::move(result);
  }
  return *as_given;
}

// The task's curves, and the dominated curves if the schedule has to stay below the constant design.
std::vector<CurveKind> DesignTuning::schedule_curves(const std::vector<double>& constant) const {
  std::vector<CurveKind> curves = curves_;
  if (!task_.dominate_constant) return curves;
  for (const CurveKind& curve : curves_) {
    if (curve.of != CurveKind::Of::objective) continue;
    curves.push_back(curve);
    curves.back().of = CurveKind::Of::dominated;
    curves.back().constant = constant;
  }
  return curves;
}

Exchange::Result DesignTuning::tune_schedule(const std::vector<double>& value,
                                             const std::vector<double>& known) {
  const std::vector<double> start = space_.constant_design(value);
  const std::vector<CurveKind> curves = schedule_curves(start);
  Exchange exchange(task_, space_, curves, effort_, stop_asked_);
  // A known design or the best path over a grid of responses starts the search; the constant design where
  // there is neither.
  Exchange::Result best;
  std::vector<double> begin = known;
  if (begin.empty() && PathSearch::serves(task_)) {
    const auto path = PathSearch(task_, limits_, effort_.orbits, stop_asked_).best(value);
    if (path) begin = path->x;
  }
  if (!begin.empty()) {
    best = exchange.run(goal(), begin);
    if (best.outcome == Outcome::converged || best.outcome == Outcome::stopped) return best;
  }
  const auto take_if_better = [&best](Exchange::Result result) {
    const bool is_better = result.has_step && result.scan.violation <= std::max(best.scan.violation, 1e-9) &&
                           result.scan.worst < best.scan.worst * (1.0 - kRoom);
    if (!best.has_step || is_better) best = std::move(result);
  };
  take_if_better(exchange.run(goal(), start));
  if (task_.objective != Objective::minimax || task_.dominate_constant) return best;
  // The best value at each knot by itself gives another start.
  take_if_better(exchange.run(goal(), place_by_place(start)));
  return best;
}

// For each knot of each schedule, the value that alone makes the objective least at the knot.
std::vector<double> DesignTuning::place_by_place(const std::vector<double>& start) {
  constexpr int kTried = 12;
  std::vector<double> x = start;
  for (const CurveKind& kind : curves_) {
    if (kind.of != CurveKind::Of::objective || kind.scenario != 0) continue;
    BandCurve curve(task_, space_, kind, effort_);
    for (std::size_t p = 0; p < space_.parameters(); ++p) {
      const DesignParameter& parameter = space_.parameter(p);
      if (!parameter.schedule) continue;
      for (std::size_t k = 0; k < space_.count(p); ++k) {
        const std::size_t variable = space_.first(p) + k;
        double least = kInfinity, best = x[variable];
        for (int i = 0; i <= kTried; ++i) {
          x[variable] = parameter.lower + (parameter.upper - parameter.lower) * i / kTried;
          if (curve.solve(x, parameter.schedule->knots[k], Derivatives::none) != TunedResponse::State::solved)
            continue;
          if (curve.value(BandCurve::larger) >= least) continue;
          least = curve.value(BandCurve::larger);
          best = x[variable];
        }
        x[variable] = best;
      }
    }
  }
  respect_slopes(space_, x);
  return x;
}

// Minimises the mean response while the worst peak is held.
void DesignTuning::settle_free_knots(double most, Stages& stages) {
  const std::vector<CurveKind> curves = schedule_curves(space_.constant_design(stages.constant_value));
  Exchange exchange(task_, space_, curves, effort_, stop_asked_);
  const Exchange::Result settled = exchange.run({Goal::Of::mean_response, most}, stages.best.x);
  stages.rounds.insert(stages.rounds.end(), settled.rounds.begin(), settled.rounds.end());
  const bool held = settled.has_step && settled.scan.worst <= most * (1.0 + 0.1 * kRoom) &&
                    settled.scan.violation <= std::max(stages.best.scan.violation, 1e-9);
  if (settled.outcome == Outcome::stopped) stages.best.outcome = Outcome::stopped;
  if (!held) return;
  stages.best.x = settled.x;
  stages.best.scan = settled.scan;
}

double DesignTuning::worst_of(std::span<const double> value) {
  const Scan scan = BandScan(task_, constant_space_, curves_, effort_, stop_asked_).of(value, 0.9, 1e-3);
  if (scan.unbounded || scan.failed) return kNone;
  return scan.worst * (1.0 + 10.0 * std::max(0.0, scan.violation));
}

double DesignTuning::objective_of(std::span<const double> x) {
  Exchange exchange(task_, space_, curves_, effort_, stop_asked_);
  return exchange.integral(goal(), x);
}

Scan DesignTuning::scan_of_worst(std::span<const double> x) {
  return BandScan(task_, space_, curves_, effort_, stop_asked_).of(x, 0.95, 1e-7);
}

Scan DesignTuning::full_scan(std::span<const double> x) {
  return BandScan(task_, space_, curves_, effort_, stop_asked_).of(x, 0.0, 1e-7);
}

}  // namespace frahm::tuning
