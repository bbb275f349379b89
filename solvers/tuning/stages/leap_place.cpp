#include "solvers/tuning/stages/leap_place.hpp"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <optional>

#include "solvers/tuning/stages/design_tuning.hpp"
#include "solvers/tuning/stages/path_search.hpp"

namespace frahm::tuning {
namespace {

constexpr int kMoves = 8;        // of the place, at most
constexpr double kFalls = 1e-7;  // of the worst peak, relative: a move that gains less is the last
constexpr int kLookedAt = 64;    // places about the leap, to both sides
constexpr double kReach = 0.05;  // of the band, to either side of the leap
constexpr double kApart = 3.0;   // leap widths between a leap and the next knot

std::size_t leaping_parameter(const Task& task) {
  const auto leaps = [](const DesignParameter& p) { return p.schedule && p.schedule->may_leap; };
  return static_cast<std::size_t>(std::ranges::find_if(task.parameters, leaps) - task.parameters.begin());
}

double leap_width(const Task& task) {
  return kLeapWidth * std::max(std::abs(task.band.from), std::abs(task.band.to));
}

// The place nearest to the leap at which the responses of both its sides are equally high, their values held.
std::optional<double> balanced_place(const Task& task, GridResponses& responses,
                                     const std::vector<double>& x) {
  const std::size_t p = leaping_parameter(task);
  const Schedule& schedule = *task.parameters[p].schedule;
  const DesignSpace space(task.parameters);
  const std::size_t side = space.first(p) + *schedule.leap;
  const double sides[] = {x[side], x[side + 1]};
  std::vector<double> constants;
  for (std::size_t q = 0; q < space.parameters(); ++q) constants.push_back(x[space.first(q)]);
  const auto differences = [&](std::span<const double> places) -> Eigen::VectorXd {
    const Eigen::MatrixXd heights = responses.grid(constants, p, places, sides).heights;
    return heights.col(0) - heights.col(1);
  };
  const double leap = 0.5 * (schedule.knots[*schedule.leap] + schedule.knots[*schedule.leap + 1]);
  const double reach = kReach * (task.band.to - task.band.from);
  std::vector<double> places;
  for (int i = -kLookedAt; i <= kLookedAt; ++i) {
    const double place = leap + reach * i / kLookedAt;
    if (place > task.band.from && place < task.band.to) places.push_back(place);
  }
  const Eigen::VectorXd difference = differences(places);
  std::optional<std::size_t> nearest;
  const auto away = [&](std::size_t i) { return std::abs(0.5 * (places[i] + places[i + 1]) - leap); };
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const double left = difference[static_cast<Eigen::Index>(i)];
    const double right = difference[static_cast<Eigen::Index>(i) + 1];
    if (!std::isfinite(left) || !std::isfinite(right) || (left < 0.0) == (right < 0.0)) continue;
    if (!nearest || away(i) < away(*nearest)) nearest = i;
  }
  if (!nearest) return std::nullopt;
  std::uintmax_t evaluations = 60;
  const auto [from, to] = boost::math::tools::toms748_solve(
      [&](double place) { return differences(std::span(&place, 1))[0]; }, places[*nearest],
      places[*nearest + 1], boost::math::tools::eps_tolerance<double>(46), evaluations);
  return 0.5 * (from + to);
}

// A design at the knots of another leap: each side goes on with its last value.
std::vector<double> moved(const Task& from, const Task& to, const std::vector<double>& x) {
  const std::size_t p = leaping_parameter(from);
  const Schedule &before = *from.parameters[p].schedule, &after = *to.parameters[p].schedule;
  const DesignSpace space(from.parameters);
  const double left_end = before.knots[*before.leap], right_end = before.knots[*before.leap + 1];
  std::vector<double> at = x;
  for (std::size_t k = 0; k < after.knots.size(); ++k) {
    const double knot = after.knots[k];
    const double held = k <= *after.leap ? std::min(knot, left_end) : std::max(knot, right_end);
    at[space.first(p) + k] = space.interpolation(p, held, x).value;
  }
  return at;
}

}  // namespace

bool may_leap(const Task& task) {
  return leaping_parameter(task) < task.parameters.size();
}

Task with_leap_at(const Task& task, double place) {
  Task leaping = task;
  Schedule& schedule = *leaping.parameters[leaping_parameter(task)].schedule;
  std::vector<double>& knots = schedule.knots;
  const double width = leap_width(task), room = kApart * width;
  place = std::clamp(place, knots.front() + room, knots.back() - room);
  const auto above = std::ranges::upper_bound(knots, place);
  const auto below = above - 1;
  if (place - *below < room) place = *below + room;
  if (*above - place < room) place = *above - room;
  schedule.leap = static_cast<std::size_t>(above - knots.begin());
  knots.insert(above, {place - 0.5 * width, place + 0.5 * width});
  return leaping;
}

Task with_knots_of(const Task& task, const Optimum& optimum) {
  Task settled = task;
  for (std::size_t p = 0; p < task.parameters.size() && p < optimum.parameters.size(); ++p) {
    std::optional<Schedule>& schedule = settled.parameters[p].schedule;
    const std::vector<double>& knots = optimum.parameters[p].knots;
    if (!schedule || knots.size() == schedule->knots.size() || knots.empty()) continue;
    schedule->knots = knots;
    const auto is_leap = [&](double left, double right) { return right - left < 1.5 * leap_width(task); };
    schedule->leap = static_cast<std::size_t>(std::ranges::adjacent_find(knots, is_leap) - knots.begin());
  }
  return settled;
}

Task with_leap_decided(const Task& task, const std::vector<QuantityLimit>& limits,
                       const std::vector<double>& value, Effort& effort,
                       const std::function<bool()>& stop_asked) {
  const double middle = 0.5 * (task.band.from + task.band.to);
  if (!PathSearch::serves(task)) return with_leap_at(task, middle);
  const auto path = PathSearch(task, limits, effort.orbits, stop_asked).best(value);
  if (!path) return with_leap_at(task, middle);
  Task best = with_leap_at(task, path->leap.value_or(middle));
  // The path's values at the knots, and at both sides of the leap those of the knots beside it.
  std::vector<double> x = path->x;
  const std::size_t leap = *best.parameters[leaping_parameter(task)].schedule->leap;
  const auto at = x.begin() + static_cast<std::ptrdiff_t>(
                                  DesignSpace(task.parameters).first(leaping_parameter(task)) + leap);
  x.insert(at, {*(at - 1), *at});
  double least = kInfinity;
  Task tried = best;
  GridResponses responses(task, limits, effort.orbits);
  for (int move = 0; move < kMoves && !stop_asked(); ++move) {
    const Exchange::Result result = DesignTuning(tried, limits, effort, stop_asked).schedules_from(x);
    if (!result.has_step || !(result.scan.worst < least * (1.0 - kFalls))) break;
    least = result.scan.worst;
    best = tried;
    x = result.x;
    const std::optional<double> balanced = balanced_place(best, responses, x);
    if (!balanced) break;
    tried = with_leap_at(task, *balanced);
    x = moved(best, tried, x);
  }
  return best;
}

}  // namespace frahm::tuning
