#include "solvers/tuning/exchange/exchange.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/exchange/band_quadrature.hpp"
#include "solvers/tuning/problem/convergence.hpp"

namespace frahm::tuning {
namespace {

constexpr double kFine = 1e-7;      // accuracy of a scan, relative to the worst peak
constexpr double kHighPeaks = 0.5;  // peaks lower than this share of the worst are left out
constexpr double kNearEnd =
    1e-2;  // the gap from which on maxima are followed and problems solved to the last digit
constexpr SolverOptions kExact{.tolerance = 1e-9, .most_iterations = 100};
constexpr SolverOptions kSettling{.tolerance = 1e-6, .most_iterations = 150};
constexpr double kClosed = 1e-9;
constexpr SolverOptions kRough{.tolerance = 1e-4, .most_iterations = 40, .feasibility = 1e-6};
constexpr int kRoundsThatDrop = 5;
constexpr double kAcceptableResidual = 1e-5;

bool is_solved(const Solution& solution) {
  return solution.ending == Ending::converged || solution.kkt_residual <= kAcceptableResidual;
}

// Fewer broken limits first, then the lower objective.
bool is_better(const Goal& goal, const Exchange::Step& step, const Scan& scan, const Exchange::Result& than) {
  const double broken = std::max(0.0, scan.violation - 1e-9);
  const double broken_before = std::max(0.0, than.scan.violation - 1e-9);
  if (broken != broken_before) return broken < broken_before;
  if (goal.of == Goal::Of::violation) return step.solution.objective > than.step.solution.objective;
  if (goal.of == Goal::Of::worst) return scan.worst < than.scan.worst;
  if (goal.of == Goal::Of::mean_response && scan.worst > goal.held * (1.0 + 1e-9))
    return scan.worst < than.scan.worst;
  return step.objective_again < than.step.objective_again;
}

}  // namespace

Exchange::Exchange(const Task& task, const DesignSpace& space, const std::vector<CurveKind>& curves,
                   Effort& effort, const std::function<bool()>& stop_asked)
    : task_(task),
      space_(space),
      curves_(curves),
      effort_(effort),
      stop_asked_(stop_asked),
      scan_(task, space, curves, effort, stop_asked) {}

// Whether maxima are followed as the design changes. Constants move sharp resonances out from between fixed
// frequencies, so their maxima are always followed. A schedule shapes the response at each band value by
// itself and has a grid at its knots, where limits once met stay met: its maxima are followed at the end.
bool Exchange::follows(bool near_end) const {
  return near_end || has_dominated(curves_) || !space_.has_schedule();
}

std::vector<QuadratureNode> Exchange::quadrature(std::span<const double> x, const Goal& goal) const {
  switch (goal.of) {
    case Goal::Of::mean_square:
      return pole_quadrature(task_, space_, curves_, x);
    case Goal::Of::mean_response:
      return knot_quadrature(task_, space_, curves_);
    default:
      return {};
  }
}

double Exchange::integral(const Goal& goal, std::span<const double> x) {
  const std::vector<ActivePoint> none;
  const std::vector<QuadratureNode> nodes = quadrature(x, goal);
  ActiveProblem problem(task_, space_, goal, curves_, none, nodes, effort_, stop_asked_);
  return problem.objective(x, {});
}

// Why the design has no variance; "" where it has one, or where the goal is another.
std::string Exchange::why_no_variance(const Goal& goal, std::span<const double> x) {
  if (goal.of != Goal::Of::variance) return "";
  const std::vector<ActivePoint> none;
  ActiveProblem problem(task_, space_, goal, curves_, none, {}, effort_, stop_asked_);
  return std::isfinite(problem.objective(x, {})) ? "" : problem.why_undefined();
}

// The best design over the active frequencies.
Exchange::Step Exchange::solve(const Goal& goal, std::span<const double> x,
                               const std::vector<ActivePoint>& active, SolverKind solver,
                               const SolverOptions& options) {
  const std::vector<QuadratureNode> nodes = quadrature(x, goal);
  ActiveProblem problem(task_, space_, goal, curves_, active, nodes, effort_, stop_asked_);
  problem.start_at(x);
  Step step;
  step.solution = tuning::solve(problem, solver, options);
  const std::vector<double>& solved = step.solution.x;
  step.x.assign(solved.begin(), solved.begin() + static_cast<std::ptrdiff_t>(space_.variables()));
  step.active = active;
  // The value of an integral changes with the nodes that suit the new design.
  step.objective_again = goal.is_epigraph() ? step.solution.objective : integral(goal, step.x);
  step.rows = problem.responses();
  std::vector<double> values(problem.constraints.size());
  problem.constrain(solved, values, {});
  step.responses = problem.responses_of(solved, values);
  return step;
}

double Exchange::gap_of(const Goal& goal, const Step& step, const Scan& scan) {
  switch (goal.of) {
    case Goal::Of::worst:
      return (scan.worst - step.solution.objective) / scan.worst;
    case Goal::Of::mean_response:
      return std::max(0.0, scan.worst / goal.held - 1.0);
    case Goal::Of::violation:
      return (1.0 + scan.violation - step.solution.objective) / (1.0 + scan.violation);
    default:
      return std::abs(step.objective_again / step.solution.objective - 1.0);
  }
}

Exchange::Result Exchange::stopped(Result result) {
  result.outcome = Outcome::stopped;
  return result;
}

// Tunes from x; where that ends outside the limits, first finds the design that breaks them least.
Exchange::Result Exchange::run(const Goal& goal, const std::vector<double>& x) {
  Result direct = run_with_either(goal, x);
  const bool settles = goal.of == Goal::Of::mean_response;  // one of several designs, and not the last word
  if (direct.outcome != Outcome::infeasible || settles) return direct;
  Result restored = run_with_either({Goal::Of::violation}, direct.x);
  restored.rounds.insert(restored.rounds.begin(), direct.rounds.begin(), direct.rounds.end());
  if (!restored.has_step) {
    direct.rounds = std::move(restored.rounds);
    return direct;
  }
  if (restored.outcome == Outcome::stopped) return restored;
  if (is_broken(restored.scan.violation)) {
    restored.breaks_least = restored.outcome == Outcome::converged;
    restored.outcome = Outcome::infeasible;
    if (!goal.is_epigraph()) restored.step.objective_again = integral(goal, restored.x);
    return restored.breaks_least ? best_of_least(goal, std::move(restored)) : restored;
  }
  Result again = run_with_either(goal, restored.x);
  again.rounds.insert(again.rounds.begin(), restored.rounds.begin(), restored.rounds.end());
  return again;
}

// For the designs that break the limits as little as `least` does, the best one.
Exchange::Result Exchange::best_of_least(const Goal& goal, Result least) {
  constexpr double kSlack = 1e-7;  // so that such designs are not a single point
  std::vector<CurveKind> held = curves_;
  for (CurveKind& curve : held) {
    const bool is_limit = curve.of == CurveKind::Of::upper_limit || curve.of == CurveKind::Of::lower_limit;
    if (is_limit) curve.excess = least.scan.violation + kSlack;
  }
  Exchange within(task_, space_, held, effort_, stop_asked_);
  const Result found = within.run_with_either(goal, least.x);
  least.rounds.insert(least.rounds.end(), found.rounds.begin(), found.rounds.end());
  if (found.outcome == Outcome::stopped) return stopped(std::move(least));
  if (!found.has_step || found.outcome == Outcome::infeasible) return least;
  const Scan scan = scan_.of(found.x, kHighPeaks, kFine);
  const bool is_lower = goal.of == Goal::Of::worst ? scan.worst < least.scan.worst
                                                   : found.step.objective_again < least.step.objective_again;
  if (is_lower) least.take(found.step, scan);
  return least;
}

// Where one solver does not get there the other tries, from the best design so far: SLSQP after Ipopt, Ipopt
// after the others.
Exchange::Result Exchange::run_with_either(const Goal& goal, const std::vector<double>& x) {
  Result first = run_with(task_.solver, goal, x);
  const bool has_more =
      first.outcome == Outcome::not_converged || (first.outcome == Outcome::failed && !first.rounds.empty());
  if (!has_more) return first;
  const SolverKind other = task_.solver == SolverKind::ipopt ? SolverKind::slsqp : SolverKind::ipopt;
  Result second = run_with(other, goal, first.has_step ? first.x : x);
  second.rounds.insert(second.rounds.begin(), first.rounds.begin(), first.rounds.end());
  const bool keeps = second.has_step && (!first.has_step || second.outcome == Outcome::converged ||
                                         is_better(goal, second.step, second.scan, first));
  if (keeps || second.outcome == Outcome::stopped) return second;
  first.rounds = std::move(second.rounds);
  return first;
}

Exchange::Result Exchange::run_with(SolverKind solver, const Goal& goal, std::vector<double> x) {
  Result result;
  result.x = x;
  result.scan = scan_.of(x, kHighPeaks, kFine);
  if (stop_asked_()) return stopped(std::move(result));
  if (const std::string why = why_no_variance(goal, x); !why.empty()) {
    result.scan.failed = true;
    result.scan.at = kNone;
    result.scan.reason = why;
  }
  if (result.scan.unbounded || result.scan.failed) {
    result.outcome = result.scan.unbounded ? Outcome::unbounded : Outcome::failed;
    return result;
  }
  if (goal.of == Goal::Of::worst && result.scan.worst == 0.0 && result.scan.violation <= 0.0) {
    result.outcome = Outcome::converged;  // nothing can be less
    return result;
  }
  const bool settles = goal.of == Goal::Of::mean_response;
  ActivePoints active(space_, curves_, goal, result.scan);
  active.join(result.scan, follows(settles));
  Convergence convergence(task_.tolerance, settles ? task_.tolerance : kClosed);
  SolverOptions options = settles ? kSettling : kRough;
  bool near_end = settles;
  bool is_last = false;
  for (int round = 0; round < task_.most_rounds && !is_last; ++round) {
    // 1. The best design over the active frequencies.
    const Step step = solve(goal, x, active.all(), solver, options);
    // 2. Its true maxima, which join them.
    const Scan found = scan_.of(step.x, kHighPeaks, kFine);
    if (stop_asked_()) return stopped(std::move(result));
    const double gap = gap_of(goal, step, found);
    result.rounds.push_back({active.all().size(), step.solution.iterations, step.solution.objective,
                             found.worst, std::max(0.0, found.violation), solver});
    if (!space_.has_schedule() && round < kRoundsThatDrop)
      active.drop_idle(step.responses, goal.is_epigraph() ? step.solution.objective : goal.held);
    const bool exact = near_end && is_solved(step.solution);
    const bool restores = goal.of == Goal::Of::violation;
    const double violation = restores ? 0.0 : std::max(0.0, found.violation);
    near_end = settles || (std::abs(gap) < kNearEnd && violation < kNearEnd);
    active.join(found, follows(near_end));
    if (!settles) options = near_end ? kExact : kRough;
    x = step.x;
    // 3. Update the best design, and decide whether another round helps.
    if (found.unbounded || found.failed) continue;
    is_last = convergence.judge(gap, violation, exact) || (restores && found.violation <= 0.0);
    const bool is_best = !result.has_step || is_better(goal, step, found, result);
    if (is_best || (is_last && convergence.met())) result.take(step, found);
  }
  conclude(goal, convergence.met(), result);
  return result;
}

bool Exchange::is_broken(double violation) const {
  return violation > std::max(task_.tolerance, 1e-9);
}

// How the rounds ended, by the best design.
void Exchange::conclude(const Goal& goal, bool gap_closed, Result& result) const {
  if (!result.has_step) {
    result.outcome = Outcome::failed;
    return;
  }
  if (goal.of != Goal::Of::violation && is_broken(result.scan.violation))
    result.outcome = Outcome::infeasible;
  else if (gap_closed && is_solved(result.step.solution))
    result.outcome = Outcome::converged;
  else
    result.outcome = Outcome::not_converged;
}

}  // namespace frahm::tuning
