#include "solvers/tuning/stages/front.hpp"

#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/stages/design_tuning.hpp"

namespace frahm::tuning {
namespace {

constexpr double kAbove = 1e-4;  // of the limit above the least value, to leave designs to choose among
constexpr double kEqual = 1e-6;  // objectives that differ by less are equal

bool is_found(const Optimum& optimum) {
  return optimum.outcome == Outcome::converged || optimum.outcome == Outcome::not_converged;
}

Optimum tuned(const Task& task, std::size_t start, const std::function<bool()>& stop_asked) {
  return tune(task, start, stop_asked).front();
}

Task without_trade_off(const Task& task) {
  Task free = task;
  free.trade_off.reset();
  return free;
}

// For the quantity of the trade-off at a design, over the task's band.
double largest_of(const Task& task, const Optimum& optimum) {
  Effort effort;
  const std::function<bool()> never = [] { return false; };
  // As a limit of 1 its curve is the quantity itself.
  DesignTuning tuning(task, {{task.trade_off->name, task.trade_off->quantity, -kInfinity, 1.0, {}}}, effort,
                      never);
  std::vector<double> x;
  for (const TunedParameter& parameter : optimum.parameters)
    x.insert(x.end(), parameter.value.begin(), parameter.value.end());
  const Scan scan = tuning.full_scan(x);
  double largest = -kInfinity;
  for (std::size_t c = 0; c < tuning.curves().size(); ++c) {
    if (tuning.curves()[c].of != CurveKind::Of::objective)
      largest = std::max(largest, scan.tightest[c].value);
  }
  return largest;
}

}  // namespace

FrontEnds front_ends(const Task& task, std::size_t start, const std::function<bool()>& stop_asked) {
  FrontEnds ends;
  const Optimum free = tuned(without_trade_off(task), start, stop_asked);
  if (is_found(free)) {
    ends.objective_at_most = free.objective;
    ends.most = largest_of(task, free);
  }
  Task least = without_trade_off(task);
  least.objective = Objective::minimax;
  least.quantity = task.trade_off->quantity;
  least.weight = {};
  least.dominate_constant = false;
  const Optimum lowest = tuned(least, start, stop_asked);
  if (!is_found(lowest)) return ends;
  ends.least = lowest.objective;
  Task at_least = without_trade_off(task);
  at_least.limits.push_back(
      {task.trade_off->name, task.trade_off->quantity, -kInfinity, ends.least * (1.0 + kAbove), {}});
  for (std::size_t p = 0; p < at_least.parameters.size(); ++p) {
    const std::vector<double>& value = lowest.parameters[p].value;
    at_least.parameters[p].nominal = value[value.size() / 2];
  }
  at_least.start = Start::given;
  const Optimum limited = tuned(at_least, 0, stop_asked);
  if (is_found(limited)) ends.objective_at_least = limited.objective;
  return ends;
}

std::vector<Undercut> undercut(const std::vector<Optimum>& optima) {
  std::vector<Undercut> found;
  for (std::size_t i = 0; i < optima.size(); ++i) {
    std::size_t best = i;
    for (std::size_t j = 0; j < optima.size(); ++j) {
      if (!is_found(optima[j]) || optima[j].trade_off > optima[i].trade_off) continue;
      const bool is_lower =
          !is_found(optima[best]) || optima[j].objective < optima[best].objective * (1.0 - kEqual);
      if (is_lower) best = j;
    }
    if (best != i) found.push_back({i, best});
  }
  return found;
}

}  // namespace frahm::tuning
