#include "solvers/tuning/stages/path_search.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"

namespace frahm::tuning {
namespace {

constexpr double kFinePieces = 120.0;  // of the band, of the path that the search ends with
constexpr std::size_t kFineLevels = 101;
constexpr double kCoarsePieces = 40.0;  // of the band, of the paths that constants are compared by
constexpr std::size_t kCoarseLevels = 21;
constexpr double kBoundPieces = 200.0;
constexpr std::size_t kBoundLevels = 201;
constexpr double kMapPoints = 64.0;  // of the constants' box
constexpr int kHalvings = 4;         // of the steps about the best of them

bool is_free(const DesignParameter& parameter) {
  return !parameter.schedule && !are_one_value(parameter.lower, parameter.upper);
}

// Whole columns within a change of the parameter, but for rounding.
std::size_t columns_within(double change, double column) {
  constexpr double kMost = 1e9;  // more than any grid has
  return static_cast<std::size_t>(std::min(change / column + 1e-9, kMost));
}

}  // namespace

bool PathSearch::serves(const Task& task) {
  const auto has_schedule = [](const DesignParameter& p) { return p.schedule.has_value(); };
  const auto scheduled = std::ranges::find_if(task.parameters, has_schedule);
  return task.objective == Objective::minimax && !task.dominate_constant &&
         std::ranges::count_if(task.parameters, has_schedule) == 1 &&
         !are_one_value(scheduled->lower, scheduled->upper) && !may_take_several_orbits(task.network);
}

PathSearch::PathSearch(const Task& task, const std::vector<QuantityLimit>& limits, std::uint64_t& orbits,
                       const std::function<bool()>& stop_asked)
    : task_(task),
      space_(task.parameters),
      stop_asked_(stop_asked),
      responses_(task, limits, orbits, stop_asked) {
  while (!parameter().schedule) ++scheduled_;
}

// The knots and points between them; bends: which of them are knots.
std::vector<double> PathSearch::places(double pieces, std::vector<std::size_t>& bends) const {
  const Schedule& schedule = *parameter().schedule;
  const double length = schedule.knots.back() - schedule.knots.front();
  std::vector<double> places;
  bends.clear();
  for (std::size_t k = 0; k + 1 < schedule.knots.size(); ++k) {
    const double from = schedule.knots[k], width = schedule.knots[k + 1] - from;
    const double parts = schedule.leap == k ? 1.0 : std::ceil(pieces * width / length);
    bends.push_back(places.size());
    for (double i = 0.0; i < parts; ++i) places.push_back(from + width * i / parts);
  }
  bends.push_back(places.size());
  places.push_back(schedule.knots.back());
  return places;
}

std::vector<double> PathSearch::levels(std::size_t count) const {
  std::vector<double> levels(count);
  for (std::size_t j = 0; j < count; ++j)
    levels[j] = std::lerp(parameter().lower, parameter().upper,
                          static_cast<double>(j) / static_cast<double>(count - 1));
  return levels;
}

// A path that may leap bends at every place, so that it may leap between any two.
BottleneckPath PathSearch::path(const std::vector<double>& value, const Fineness& fineness) {
  const Schedule& schedule = *parameter().schedule;
  const bool seeks_leap = schedule.may_leap && !schedule.leap;
  std::vector<std::size_t> bends;
  const std::vector<double> at = places(fineness.pieces, bends), over = levels(fineness.levels);
  if (seeks_leap) {
    bends.resize(at.size());
    for (std::size_t i = 0; i < bends.size(); ++i) bends[i] = i;
  }
  // The columns that fit into each piece; remainders add up, so that many short pieces climb as far as a long
  // one.
  std::vector<std::size_t> steps;
  const double column = over[1] - over[0];
  const auto climbed = [&](std::size_t bend) {
    return columns_within(schedule.max_slope * (at[bend] - at.front()), column);
  };
  for (std::size_t k = 0; k + 1 < bends.size(); ++k) {
    const bool is_leap = !seeks_leap && schedule.leap == k;
    const bool is_free = is_leap || std::isinf(schedule.max_slope);
    steps.push_back(is_free ? over.size()
                    : seeks_leap
                        ? climbed(bends[k + 1]) - climbed(bends[k])
                        : columns_within(schedule.max_slope * (at[bends[k + 1]] - at[bends[k]]), column));
  }
  const ResponseGrid grid = responses_.grid(value, scheduled_, at, over);
  return bottleneck_path(grid.heights, bends, steps, seeks_leap);
}

// A map of the box of the constants, then steps about its best point, halved where none helps.
std::vector<double> PathSearch::best_constants(const std::vector<double>& value) {
  std::vector<std::size_t> free;
  for (std::size_t p = 0; p < task_.parameters.size(); ++p) {
    if (is_free(task_.parameters[p])) free.push_back(p);
  }
  std::vector<double> best = value;
  if (free.empty()) return best;
  double least = kInfinity;
  const auto consider = [&](const std::vector<double>& tried) {
    if (stop_asked_()) return false;
    const double worst = path(tried, {kCoarsePieces, kCoarseLevels}).worst;
    if (!(worst < least)) return false;
    least = worst;
    best = tried;
    return true;
  };
  const auto many = static_cast<std::size_t>(
      std::clamp(std::pow(kMapPoints, 1.0 / static_cast<double>(free.size())), 2.0, 24.0) + 1e-9);
  std::size_t points = 1;
  for (std::size_t i = 0; i < free.size() && points < 4096; ++i) points *= many;
  consider(value);
  for (std::size_t point = 0; point < points; ++point) {
    std::vector<double> tried = value;
    std::size_t rest = point;
    for (const std::size_t p : free) {
      const double share = (static_cast<double>(rest % many) + 0.5) / static_cast<double>(many);
      tried[p] = std::lerp(task_.parameters[p].lower, task_.parameters[p].upper, share);
      rest /= many;
    }
    consider(tried);
  }
  double step = 0.5 / static_cast<double>(many);  // of the range
  for (int halving = 0; halving < kHalvings && !stop_asked_();) {
    bool helped = false;
    for (const std::size_t p : free) {
      const DesignParameter& constant = task_.parameters[p];
      for (const double way : {-1.0, 1.0}) {
        std::vector<double> tried = best;
        tried[p] = std::clamp(best[p] + way * step * (constant.upper - constant.lower), constant.lower,
                              constant.upper);
        if (consider(tried)) helped = true;
      }
    }
    if (helped) continue;
    step *= 0.5;
    ++halving;
  }
  return best;
}

std::optional<PathDesign> PathSearch::best(const std::vector<double>& value) {
  const std::vector<double> constants = best_constants(value);
  const Fineness fine{kFinePieces, kFineLevels};
  const BottleneckPath found = path(constants, fine);
  if (stop_asked_() || std::isinf(found.worst)) return std::nullopt;
  std::vector<std::size_t> bends;
  const std::vector<double> at = places(fine.pieces, bends), over = levels(fine.levels);
  PathDesign design{.x = space_.constant_design(constants), .worst = found.worst, .leap = std::nullopt};
  const bool bends_everywhere = found.levels.size() == at.size();
  for (std::size_t k = 0; k < bends.size(); ++k)
    design.x[space_.first(scheduled_) + k] = over[found.levels[bends_everywhere ? bends[k] : k]];
  if (found.leap) design.leap = 0.5 * (at[*found.leap] + at[*found.leap + 1]);
  return design;
}

double PathSearch::bound(const std::vector<double>& x) {
  const Schedule& schedule = *parameter().schedule;
  std::vector<double> constants;
  for (std::size_t p = 0; p < space_.parameters(); ++p) constants.push_back(x[space_.first(p)]);
  const std::vector<double> over = levels(kBoundLevels);
  std::vector<double> at;
  std::vector<std::size_t> bends, steps;
  for (double i = 0.0; i <= kBoundPieces; ++i) {
    bends.push_back(at.size());
    at.push_back(std::lerp(schedule.knots.front(), schedule.knots.back(), i / kBoundPieces));
  }
  // |v - w| <= change, v in [a, a + 1), w in [b, b + 1) of columns: |a - b| < change + 1.
  const double change = schedule.max_slope * (at[1] - at[0]) / (over[1] - over[0]);
  steps.assign(at.size() - 1, std::isinf(change) ? over.size() : static_cast<std::size_t>(std::ceil(change)));
  const ResponseGrid grid = responses_.grid(constants, scheduled_, at, over);
  const double bound = bottleneck_path(grid.cells, bends, steps, schedule.may_leap).worst;
  return std::isfinite(bound) ? bound : kNone;
}

}  // namespace frahm::tuning
