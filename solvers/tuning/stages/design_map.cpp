#include "solvers/tuning/stages/design_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/exchange/band_scan.hpp"

namespace frahm::tuning {
namespace {

constexpr std::size_t kMostParameters = 3;
constexpr int kCells[] = {1, 33, 11, 7};  // along each of 0 to 3 parameters
// Nearer to a resonance without damping lies no design worth a search, and an orbit there takes long.
constexpr PlacesFineness kSampled{.intervals = 16, .nearest = 1e-3};
constexpr double kDecade = 10.0;

bool varies(const DesignParameter& parameter) {
  return !are_one_value(parameter.lower, parameter.upper);
}

std::size_t varying(const std::vector<DesignParameter>& parameters) {
  return static_cast<std::size_t>(std::ranges::count_if(parameters, varies));
}

double between(const DesignParameter& parameter, double share) {
  const auto& [lower, upper] = std::pair(parameter.lower, parameter.upper);
  const bool by_ratios = lower > 0.0 && upper > kDecade * lower;
  const double value = by_ratios ? lower * std::pow(upper / lower, share) : std::lerp(lower, upper, share);
  return std::clamp(value, lower, upper);
}

// Where each varying parameter's cell is, the first one's first.
std::vector<int> place_of(std::size_t cell, std::size_t dimensions, int along) {
  std::vector<int> place(dimensions);
  for (int& at : place) {
    at = static_cast<int>(cell % static_cast<std::size_t>(along));
    cell /= static_cast<std::size_t>(along);
  }
  return place;
}

// What of a cell is to be low: both measures jointly or, where no cell meets the limits, the violation;
// infinite where a cell has no value.
std::vector<double> heights(const DesignMap& map) {
  const bool some_meet = std::ranges::any_of(map.merit, [](const DesignMerit& merit) {
    return std::isfinite(merit.objective) && merit.violation <= 0.0;
  });
  std::vector<double> heights;
  for (const DesignMerit& merit : map.merit) {
    const double height = some_meet ? merit.joint() : merit.violation;
    heights.push_back(std::isfinite(merit.objective) && std::isfinite(height) ? height : kInfinity);
  }
  return heights;
}

// Calls each(neighbour) for all cells of the map next to a cell.
template <class Each>
void for_neighbours(const DesignMap& map, std::size_t cell, const Each& each) {
  const auto& [dimensions, along] = std::pair(map.dimensions, map.along);
  const std::vector<int> place = place_of(cell, dimensions, along);
  const auto directions =
      static_cast<std::size_t>(std::lround(std::pow(3.0, static_cast<double>(dimensions))));
  for (std::size_t direction = 0; direction < directions; ++direction) {
    const std::vector<int> step = place_of(direction, dimensions, 3);
    std::size_t neighbour = 0, stride = 1;
    bool inside = true;
    for (std::size_t d = 0; d < dimensions; ++d) {
      const int at = place[d] + step[d] - 1;
      inside = inside && at >= 0 && at < along;
      neighbour += stride * static_cast<std::size_t>(std::max(at, 0));
      stride *= static_cast<std::size_t>(along);
    }
    if (inside && neighbour != cell && neighbour < map.merit.size()) each(neighbour);
  }
}

// The cells that no neighbour undercuts, the lowest first.
std::vector<std::size_t> lowest_cells(const DesignMap& map, const std::vector<double>& height) {
  std::vector<std::size_t> low;
  for (std::size_t cell = 0; cell < height.size(); ++cell) {
    bool lowest = std::isfinite(height[cell]);
    for_neighbours(map, cell, [&](std::size_t other) { lowest = lowest && height[other] >= height[cell]; });
    if (lowest) low.push_back(cell);
  }
  std::ranges::stable_sort(low, {}, [&](std::size_t cell) { return height[cell]; });
  return low;
}

}  // namespace

double DesignMerit::joint() const {
  return objective * (1.0 + 10.0 * std::max(0.0, violation));
}

std::size_t DesignMap::seen() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(merit, [](const DesignMerit& each) { return std::isfinite(each.objective); }));
}

bool may_be_mapped(const Task& task) {
  constexpr double kMostWork = 1e5;  // responses times masses
  const std::size_t curves = task.scenarios.size() * (1 + task.limits.size() + (task.trade_off ? 1 : 0));
  const std::size_t dimensions = varying(task.parameters);
  if (dimensions == 0 || dimensions > kMostParameters || may_take_several_orbits(task.network)) return false;
  const double cells = std::pow(kCells[dimensions], static_cast<double>(dimensions));
  const double responses = cells * static_cast<double>(curves) * 1.5 * kSampled.intervals;
  return responses * static_cast<double>(std::max<std::size_t>(1, task.network.masses.size())) <= kMostWork;
}

DesignMap map_designs(const DesignSpace& space, const MeritAt& merit_at,
                      const std::function<bool()>& stop_asked) {
  std::vector<std::size_t> axes;
  std::vector<double> value;
  for (std::size_t p = 0; p < space.parameters(); ++p) {
    value.push_back(space.parameter(p).lower);
    if (varies(space.parameter(p))) axes.push_back(p);
  }
  DesignMap map{.dimensions = axes.size(),
                .along = kCells[std::min(axes.size(), kMostParameters)],
                .design = {},
                .merit = {}};
  const auto cells =
      static_cast<std::size_t>(std::lround(std::pow(map.along, static_cast<double>(axes.size()))));
  for (std::size_t cell = 0; cell < cells && !stop_asked(); ++cell) {
    const std::vector<int> place = place_of(cell, axes.size(), map.along);
    for (std::size_t d = 0; d < axes.size(); ++d)
      value[axes[d]] = between(space.parameter(axes[d]), (place[d] + 0.5) / map.along);
    map.design.push_back(value);
    map.merit.push_back(merit_at(value));
  }
  return map;
}

std::vector<std::vector<double>> lowest_places(const DesignMap& map, std::size_t most) {
  const std::vector<std::size_t> low = lowest_cells(map, heights(map));
  std::vector<std::vector<double>> places;
  for (std::size_t i = 0; i < std::min(most, low.size()); ++i) places.push_back(map.design[low[i]]);
  return places;
}

std::vector<std::vector<double>> low_places_elsewhere(const DesignMap& map, std::size_t most) {
  const std::vector<double> height = heights(map);
  std::vector<std::size_t> taken = lowest_cells(map, height);
  std::vector<std::size_t> by_height(height.size());
  std::iota(by_height.begin(), by_height.end(), std::size_t{0});
  std::ranges::stable_sort(by_height, {}, [&](std::size_t cell) { return height[cell]; });
  std::vector<std::vector<double>> places;
  for (const std::size_t cell : by_height) {
    if (places.size() == most || !std::isfinite(height[cell])) break;
    const bool is_near = std::ranges::any_of(taken, [&](std::size_t other) {
      bool beside = other == cell;
      for_neighbours(map, cell, [&](std::size_t n) { beside = beside || n == other; });
      return beside;
    });
    if (is_near) continue;
    taken.push_back(cell);
    places.push_back(map.design[cell]);
  }
  return places;
}

SampledCurves::SampledCurves(const Task& task, const DesignSpace& space, const std::vector<CurveKind>& curves,
                             Effort& effort, const std::function<bool()>& stop_asked)
    : task_(task), space_(space), curves_(curves) {
  responses_.reserve(curves.size());
  for (const CurveKind& curve : curves)
    responses_.emplace_back(task, space, curve, effort).end_rows_when(stop_asked);
}

DesignMerit SampledCurves::at(std::span<const double> value) {
  DesignMerit merit{.objective = 0.0, .violation = -kInfinity};
  std::vector<double> places;
  for (std::size_t c = 0; c < curves_.size(); ++c) {
    const CurveKind& kind = curves_[c];
    const bool as_before = c > 0 && kind.scenario == curves_[c - 1].scenario &&
                           kind.band.from == curves_[c - 1].band.from &&
                           kind.band.to == curves_[c - 1].band.to;
    // Constants leap nowhere: one stretch.
    if (!as_before) places = places_of(task_, space_, kind, value, kSampled).front();
    responses_[c].values(value, places, heights_);
    if (std::ranges::any_of(heights_, [](double height) { return std::isnan(height); }))
      return {kNone, kNone};
    const double highest = *std::ranges::max_element(heights_);
    double& tightest = kind.of == CurveKind::Of::objective ? merit.objective : merit.violation;
    tightest = std::max(tightest, kind.of == CurveKind::Of::objective ? highest : highest - kind.most());
  }
  return merit;
}

}  // namespace frahm::tuning
