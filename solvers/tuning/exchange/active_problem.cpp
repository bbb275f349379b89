#include "solvers/tuning/exchange/active_problem.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/exchange/followed_maximum.hpp"

namespace frahm::tuning {
namespace {

// Adds factor x d value / d x to `gradient` (of all variables).
void add_gradient(const DesignSpace& space, const BandCurve& curve, std::size_t side, double factor,
                  std::span<double> gradient) {
  for (std::size_t p = 0; p < space.parameters(); ++p) {
    const DesignSpace::Interpolation& at_knots = curve.response().interpolation(p);
    for (int i = 0; i < at_knots.count; ++i)
      gradient[at_knots.shares[i].variable] += factor * at_knots.shares[i].weight * curve.derivative(side, p);
  }
}

}  // namespace

ActiveProblem::ActiveProblem(const Task& task, const DesignSpace& space, const Goal& goal,
                             const std::vector<CurveKind>& curves, const std::vector<ActivePoint>& active,
                             const std::vector<QuadratureNode>& nodes, Effort& effort,
                             const std::function<bool()>& stop_asked)
    : task_(task),
      space_(space),
      goal_(goal),
      curves_(curves),
      active_(active),
      nodes_(nodes),
      stop_asked_(stop_asked) {
  for (const ActivePoint& point : active_)
    responses_.push_back(std::make_unique<BandCurve>(task, space, curves_[point.curve], effort));
  for (std::size_t s = 0; s < task.scenarios.size(); ++s)
    node_curves_.push_back({.scenario = s, .quantity = task.quantity, .band = task.band, .constant = {}});
  for (const QuadratureNode& node : nodes_)
    node_responses_.push_back(std::make_unique<BandCurve>(task, space, node_curves_[node.scenario], effort));
  if (goal.of == Goal::Of::variance) {
    const bool is_stroke = task.quantity.measure == periodic::Measure::stroke;
    const NoisyKind kind = is_stroke ? NoisyKind::stroke : NoisyKind::displacement;
    variance_.emplace(task.network, task.noise, NoisyQuantity{kind, task.quantity.index});
  }
  name_variables();
  add_response_rows();
  add_slope_rows();
}

void ActiveProblem::name_variables() {
  for (std::size_t i = 0; i < space_.variables(); ++i) {
    const DesignParameter& parameter = space_.parameter(space_.parameter_of(i));
    Variable variable{.name = parameter.name, .lower = parameter.lower, .upper = parameter.upper};
    if (parameter.schedule) {
      variable.name.append(1, '[');
      variable.name.append(std::to_string(i - space_.first(space_.parameter_of(i))));
      variable.name.append(1, ']');
    }
    const double range = parameter.upper - parameter.lower;
    const double size = std::max(std::abs(parameter.lower), std::abs(parameter.upper));
    variable.scale = range > 0.0 ? range : size > 0.0 ? size : 1.0;
    variables.push_back(variable);
  }
  if (!has_bound_variable()) return;
  // A design well within its limits is not sought: another goal goes on from there.
  constexpr double kWellWithin = 1.0 - 1e-3;
  const bool violation = goal_.of == Goal::Of::violation;
  variables.push_back({.name = "worst", .lower = violation ? kWellWithin : 0.0});
}

void ActiveProblem::add_response_rows() {
  response_rows_ = {constraints.size(), active_.size()};
  const std::vector<double> somewhere(space_.variables(), 0.0);
  for (const ActivePoint& point : active_) {
    const bool epigraph = is_epigraph(point.curve);
    const std::size_t row = constraints.size();
    constraints.push_back({.name = "response", .upper = epigraph ? 0.0 : bound_of(point.curve)});
    for (std::size_t p = 0; p < space_.parameters(); ++p) {
      const DesignSpace::Interpolation at_knots = space_.interpolation(p, point.at, somewhere);
      for (int k = 0; k < at_knots.count; ++k) jacobian.push_back({row, at_knots.shares[k].variable});
    }
    if (epigraph) jacobian.push_back({row, space_.variables()});
  }
}

void ActiveProblem::add_slope_rows() {
  for (std::size_t p = 0; p < space_.parameters(); ++p) {
    const auto& schedule = space_.parameter(p).schedule;
    if (!schedule || std::isinf(schedule->max_slope)) continue;
    slope_rows_.push_back({{constraints.size(), schedule->knots.size() - 1}, space_.first(p)});
    for (std::size_t k = 0; k + 1 < schedule->knots.size(); ++k) {
      const std::size_t variable = space_.first(p) + k;
      // Over a leap only the bounds hold, which the row's limit lies beyond.
      const double most = schedule->leap == k
                              ? 2.0 * variables[variable].scale
                              : schedule->max_slope * (schedule->knots[k + 1] - schedule->knots[k]);
      constraints.push_back(
          {.name = "slope", .lower = -most, .upper = most, .scale = variables[variable].scale});
      jacobian.push_back({constraints.size() - 1, variable});
      jacobian.push_back({constraints.size() - 1, variable + 1});
    }
  }
}

void ActiveProblem::start_at(std::span<const double> x) {
  for (std::size_t i = 0; i < x.size(); ++i) variables[i].start = x[i];
  double worst = 0.0;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const bool counts = goal_.of == Goal::Of::violation
                            ? is_epigraph(active_[i].curve)
                            : curves_[active_[i].curve].of == CurveKind::Of::objective;
    if (!counts) continue;
    if (responses_[i]->solve(x, active_[i].at, Derivatives::none) != TunedResponse::State::solved) continue;
    worst = std::max(worst, responses_[i]->value(BandCurve::larger));
  }
  const double size = worst > 0.0 ? worst : goal_.held > 0.0 ? goal_.held : 1.0;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const bool of_objective = curves_[active_[i].curve].of == CurveKind::Of::objective;
    constraints[response_rows_.first + i].scale = of_objective || is_epigraph(active_[i].curve) ? size : 1.0;
  }
  if (has_bound_variable()) {
    variables.back().start = worst;
    variables.back().scale = objective_scale = size;
  } else {
    objective_scale = 1.0;
    const double value = objective(x, {});
    if (std::isfinite(value) && value != 0.0) objective_scale = std::abs(value);
  }
}

double ActiveProblem::objective(std::span<const double> x, std::span<double> gradient) {
  std::fill(gradient.begin(), gradient.end(), 0.0);
  if (has_bound_variable()) {
    if (!gradient.empty()) gradient.back() = 1.0;
    return x.back();
  }
  return goal_.of == Goal::Of::variance ? variance(x, gradient) : integral(x, gradient);
}

double ActiveProblem::integral(std::span<const double> x, std::span<double> gradient) {
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    BandCurve& curve = *node_responses_[i];
    if (curve.solve(x, nodes_[i].at, gradient.empty() ? Derivatives::none : Derivatives::all) !=
        TunedResponse::State::solved)
      return kNone;
    const double value = curve.value(BandCurve::larger), weight = nodes_[i].weight;
    const bool square = goal_.of == Goal::Of::mean_square;
    sum += weight * (square ? value * value : value);
    if (!gradient.empty())
      add_gradient(space_, curve, BandCurve::larger, weight * (square ? 2.0 * value : 1.0), gradient);
  }
  return sum;
}

// The mean over the scenarios. There are no schedules, so each parameter is one variable.
double ActiveProblem::variance(std::span<const double> x, std::span<double> gradient) {
  std::vector<double> at(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(space_.parameters()));
  at.push_back(task_.band.from);
  mechanics::NetworkValues values;
  std::vector<mechanics::NetworkValues> directions;
  std::vector<double> slopes(at.size());
  const double share = 1.0 / static_cast<double>(task_.scenarios.size());
  double sum = 0.0;
  try {
    for (std::size_t s = 0; s < task_.scenarios.size(); ++s) {
      task_.network_at(s, at, values, &directions);
      sum += share * variance_->mean_square(values, directions, slopes);
      for (std::size_t p = 0; p < space_.parameters() && !gradient.empty(); ++p)
        gradient[p] += share * slopes[p];
    }
  } catch (const mechanics::MechanicsError& error) {
    why_undefined_ = error.what();
    return kNone;  // infinite, or a value out of range: the step is taken back
  }
  return sum;
}

std::vector<double> ActiveProblem::responses_of(std::span<const double> x,
                                                std::span<const double> values) const {
  const auto rows = values.subspan(response_rows_.first, response_rows_.count);
  std::vector<double> responses(rows.begin(), rows.end());
  for (std::size_t i = 0; i < responses.size(); ++i) {
    if (is_epigraph(active_[i].curve)) responses[i] += x.back();
  }
  return responses;
}

void ActiveProblem::constrain(std::span<const double> x, std::span<double> values,
                              std::span<double> entries) {
  // The Jacobian's entries are in the order of the blocks.
  std::size_t entry = constrain_responses(x, values, entries);
  for (const SlopeRows& slopes : slope_rows_) {
    for (std::size_t k = 0; k < slopes.rows.count; ++k) {
      const std::size_t knot = slopes.first_knot + k;
      values[slopes.rows.first + k] = x[knot + 1] - x[knot];
      if (entries.empty()) continue;
      entries[entry++] = -1.0;
      entries[entry++] = 1.0;
    }
  }
}

// Returns how many entries of the Jacobian the block has filled.
std::size_t ActiveProblem::constrain_responses(std::span<const double> x, std::span<double> values,
                                               std::span<double> entries) {
  std::size_t entry = 0;
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const ActivePoint& point = active_[i];
    BandCurve& curve = *responses_[i];
    const Derivatives derivatives = entries.empty() ? Derivatives::none : Derivatives::all;
    const bool solved =
        point.followed ? follow_maximum(curve, x, point.at, point.from, point.to, point.side, derivatives)
                       : curve.solve(x, point.at, derivatives) == TunedResponse::State::solved;
    const bool epigraph = is_epigraph(point.curve);
    double& value = values[response_rows_.first + i];
    value = solved ? curve.value(point.side) - (epigraph ? x.back() : 0.0) : kNone;
    if (entries.empty()) continue;
    for (std::size_t p = 0; p < space_.parameters(); ++p) {
      const DesignSpace::Interpolation& at_knots = curve.response().interpolation(p);
      for (int k = 0; k < at_knots.count; ++k)
        entries[entry++] = solved ? at_knots.shares[k].weight * curve.derivative(point.side, p) : kNone;
    }
    if (epigraph) entries[entry++] = -1.0;
  }
  return entry;
}

}  // namespace frahm::tuning
