#include "solvers/tuning/problem/scaled_problem.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"

namespace frahm::tuning {
namespace {

constexpr double kRunaway =
    1e15;  // scaled: beyond it an objective or a variable is taken to grow without limit

constexpr double kSettling =
    1e-3;  // of the objective's scale: what the last steps to an optimum gain at most

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

std::string reason_of(Ending ending, const std::string& library) {
  switch (ending) {
    case Ending::converged:
      return "the KKT residual is within the tolerance";
    case Ending::acceptable:
      return "the solver made no further progress (" + library + "), with a KKT residual that is small";
    case Ending::diverging:
      return "the objective falls, or a variable grows, without limit";
    case Ending::stopped:
      return "a stop was requested";
    default:
      return library;
  }
}

}  // namespace

ScaledProblem::ScaledProblem(Problem& problem, const SolverOptions& options, Judging judging)
    : problem_(problem),
      options_(options),
      with_derivatives_(judging != Judging::values),
      with_residuals_(judging == Judging::residuals) {
  check(problem);
  std::vector<std::size_t> place(problem.variables.size(), problem.variables.size());
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const Variable& v = problem.variables[i];
    at_.x.push_back(std::clamp(v.start, v.lower, v.upper));
    if (are_one_value(v.lower, v.upper)) continue;
    place[i] = free_.size();
    free_.push_back(i);
  }
  for (std::size_t e = 0; e < problem.jacobian.size(); ++e) {
    const auto [j, i] = problem.jacobian[e];
    if (place[i] == problem.variables.size()) continue;
    entry_.push_back(e);
    jacobian_.push_back({j, place[i]});
  }
  at_.gradient.resize(problem.variables.size());
  at_.values.resize(problem.constraints.size());
  at_.entries.resize(problem.jacobian.size());
}

double ScaledProblem::constraint_lower(std::size_t j) const {
  return problem_.constraints[j].lower / problem_.constraints[j].scale;
}

double ScaledProblem::constraint_upper(std::size_t j) const {
  return problem_.constraints[j].upper / problem_.constraints[j].scale;
}

std::vector<double> ScaledProblem::start() const {
  std::vector<double> x(size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = std::clamp(variable(i).start, variable(i).lower, variable(i).upper) / variable(i).scale;
  }
  return x;
}

double ScaledProblem::slope(std::size_t i) const {
  return at_.gradient[free_[i]] * variable(i).scale / problem_.objective_scale;
}

double ScaledProblem::value(std::size_t j) const {
  return at_.values[j] / problem_.constraints[j].scale;
}

double ScaledProblem::derivative(std::size_t e) const {
  const auto [j, i] = jacobian_[e];
  return at_.entries[entry_[e]] * variable(i).scale / problem_.constraints[j].scale;
}

// With multipliers by least squares.
double ScaledProblem::residual() const {
  return kkt_residual(problem_, at_, least_squares_multipliers(problem_, at_));
}

std::vector<double> ScaledProblem::best() const {
  if (!best_) return start();
  std::vector<double> x(size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = best_->x[free_[i]] / variable(i).scale;
  return x;
}

// Moves x into the bounds: a division and a multiplication by the scale may leave them by a rounding.
std::vector<double> ScaledProblem::unscaled(std::span<const double> x) const {
  std::vector<double> whole = at_.x;
  for (std::size_t i = 0; i < size(); ++i) {
    whole[free_[i]] = std::clamp(x[i] * variable(i).scale, variable(i).lower, variable(i).upper);
  }
  return whole;
}

bool ScaledProblem::can_start() {
  const bool defined = go_to(start());
  solution_.reason = defined ? "every variable is fixed" : "the problem is not defined at the start";
  return defined && size() > 0;
}

bool ScaledProblem::go_to(std::span<const double> x) {
  if (ends()) return false;
  const std::vector<double> whole = unscaled(x);
  if (solution_.evaluations > 0 && whole == at_.x) return defined_;
  return evaluate(whole);
}

bool ScaledProblem::evaluate(const std::vector<double>& x) {
  at_.x = x;
  defined_ = false;
  ++solution_.evaluations;
  try {
    if ((stopped_ = problem_.stop_asked())) return false;
    linearize(x);
  } catch (...) {
    failure_ = std::current_exception();
    return false;
  }
  if (defined_) note_point();
  return defined_ && !ends();
}

void ScaledProblem::linearize(const std::vector<double>& x) {
  at_.x = x;
  const bool all = with_derivatives_;
  at_.objective = problem_.objective(x, all ? std::span<double>(at_.gradient) : std::span<double>());
  if (!problem_.constraints.empty()) {
    problem_.constrain(x, at_.values, all ? std::span<double>(at_.entries) : std::span<double>());
  }
  defined_ = is_defined();
}

bool ScaledProblem::is_defined() const {
  if (!std::isfinite(at_.objective) || !all_finite(at_.values)) return false;
  return !with_derivatives_ || (all_finite(at_.gradient) && all_finite(at_.entries));
}

// A feasible point is better than an infeasible one, a lower one better than a higher one; between feasible
// points of equal objective the smaller KKT residual decides.
bool ScaledProblem::is_better(const Best& one, const Best& other) const {
  const bool feasible = one.infeasibility <= options_.feasibility;
  if (!feasible || other.infeasibility > options_.feasibility) return one.infeasibility < other.infeasibility;
  const double gain = (other.objective - one.objective) / problem_.objective_scale;
  const bool level = std::abs(gain) <= options_.tolerance && std::isfinite(one.residual);
  return level ? !(one.residual >= other.residual) : gain > 0.0;
}

// Whether a check is worth while: an optimum is feasible, and the last steps to it gain little.
bool ScaledProblem::may_be_optimal(const Best& here) const {
  return best_ && here.infeasibility <= options_.feasibility &&
         std::abs(here.objective - best_->objective) <= kSettling * problem_.objective_scale;
}

void ScaledProblem::note_point() {
  worst_ = std::max(worst_, objective());
  Best here{at_.x, at_.objective, infeasibility(problem_, at_.values)};
  if (with_residuals_ && may_be_optimal(here)) here.residual = residual();
  if (!best_ || is_better(here, *best_)) {
    best_ = here;
    ++improvements_;
  }
  diverging_ = objective() < -kRunaway;
  for (const std::size_t i : free_) {
    diverging_ = diverging_ || std::abs(at_.x[i]) > kRunaway * problem_.variables[i].scale;
  }
}

void ScaledProblem::note_iteration(int iteration, double infeasibility, double optimality, double objective) {
  solution_.history.push_back({iteration, objective * problem_.objective_scale, infeasibility, optimality});
}

// A fixed variable is made stationary by the multiplier of one of its bounds.
void ScaledProblem::hold_fixed(Multipliers& multipliers) const {
  std::vector<double> slope = at_.gradient;
  for (std::size_t e = 0; e < problem_.jacobian.size(); ++e) {
    const auto [j, i] = problem_.jacobian[e];
    slope[i] += multipliers.constraint[j] * at_.entries[e];
  }
  for (std::size_t i = 0; i < slope.size(); ++i) {
    if (problem_.variables[i].lower != problem_.variables[i].upper) continue;
    multipliers.lower[i] = std::max(0.0, slope[i]);
    multipliers.upper[i] = std::max(0.0, -slope[i]);
  }
}

// With at_ and the multipliers.
Solution ScaledProblem::conclude(Multipliers multipliers, Ending ending) const {
  Solution result = solution_;
  hold_fixed(multipliers);
  result.x = at_.x;
  result.objective = at_.objective;
  result.infeasibility = infeasibility(problem_, at_.values);
  result.kkt_residual = kkt_residual(problem_, at_, multipliers);
  const bool feasible = result.infeasibility <= options_.feasibility;
  if (diverging_) ending = Ending::diverging;
  if (feasible && result.kkt_residual <= kAcceptable * options_.tolerance) ending = Ending::acceptable;
  if (feasible && result.kkt_residual <= options_.tolerance) ending = Ending::converged;
  if (!feasible && ending == Ending::failed) ending = Ending::infeasible;
  if (stopped_) ending = Ending::stopped;
  result.ending = ending;
  result.reason = reason_of(ending, solution_.reason);
  result.lower_multipliers = std::move(multipliers.lower);
  result.upper_multipliers = std::move(multipliers.upper);
  result.constraint_multipliers = std::move(multipliers.constraint);
  return result;
}

Solution ScaledProblem::finish(Ending ending) {
  if (failure_) std::rethrow_exception(failure_);
  const std::size_t n = problem_.variables.size();
  with_derivatives_ = true;
  linearize(best_ ? best_->x : unscaled(start()));
  if (defined_) return conclude(least_squares_multipliers(problem_, at_), ending);
  // Without a gradient here the point cannot be shown to be an optimum.
  Solution result =
      conclude({std::vector<double>(n), std::vector<double>(n), std::vector<double>(constraints())}, ending);
  result.ending = stopped_ ? Ending::stopped : ending;
  result.reason = reason_of(result.ending, solution_.reason);
  result.kkt_residual = kNone;
  return result;
}

Solution ScaledProblem::finish_at(std::span<const double> x, std::span<const double> lower,
                                  std::span<const double> upper, std::span<const double> constraint,
                                  Ending ending) {
  if (failure_) std::rethrow_exception(failure_);
  Multipliers multipliers{std::vector<double>(problem_.variables.size()),
                          std::vector<double>(problem_.variables.size()), std::vector<double>(constraints())};
  for (std::size_t i = 0; i < size(); ++i) {
    multipliers.lower[free_[i]] = lower[i] * problem_.objective_scale / variable(i).scale;
    multipliers.upper[free_[i]] = upper[i] * problem_.objective_scale / variable(i).scale;
  }
  for (std::size_t j = 0; j < constraints(); ++j) {
    multipliers.constraint[j] = constraint[j] * problem_.objective_scale / problem_.constraints[j].scale;
  }
  linearize(unscaled(x));
  if (!defined_) return finish(ending);
  Solution last = conclude(std::move(multipliers), ending);
  if (last.ending == Ending::converged || last.ending == Ending::acceptable) return last;
  return finish(ending);
}

}  // namespace frahm::tuning
