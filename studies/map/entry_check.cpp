#include "studies/map/entry_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/bad_entry.hpp"
#include "results/utf8.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "studies/map/tile_entry.hpp"

namespace frahm::studies {
namespace {

using engine::BadEntry;

void check_values(const MapPlan& plan, std::span<const double> values, std::uint64_t points) {
  for (std::size_t q = 0; q < plan.variables.size(); ++q) {
    for (const double value : values.subspan(q * points, points)) {
      if (!is_possible(value, plan.variables[q]))
        throw BadEntry(fmt::format("{} cannot be {}", plan.variables[q].name, value));
    }
  }
}

void check_failed(std::span<const FailedPoint> failed, std::uint64_t points) {
  if (failed.size() > points)
    throw BadEntry(fmt::format("{} of its {} points failed", failed.size(), points));
  for (const FailedPoint& point : failed) {
    if (point.offset >= points) throw BadEntry(fmt::format("point {} of {} failed", point.offset, points));
    try {
      results::check_utf8("reason", point.reason);
    } catch (const std::invalid_argument& reason) {
      throw BadEntry(reason.what());
    }
  }
}

// Whether a point of the tile has a neighbour along the dimension.
bool has_neighbour(const MapPlan& plan, const MapBox& box, const Border& border) {
  if (border.offset >= box.points() || border.dimension >= box.count.size()) return false;
  std::uint64_t rest = border.offset;
  for (std::size_t d = box.count.size(); --d > border.dimension;) rest /= box.count[d];
  const std::uint64_t index = box.start[border.dimension] + rest % box.count[border.dimension];
  return index + 1 < plan.grid.shape[border.dimension];
}

void check_borders(const MapPlan& plan, std::span<const Border> borders, const MapBox& box) {
  const auto elements = static_cast<std::size_t>(
      std::ranges::count_if(plan.study.network.elements, mechanics::has_own_contact));
  const auto is_regime = [](periodic::Regime regime) {
    return regime >= periodic::Regime::not_computed && regime <= periodic::Regime::stuck;
  };
  for (const Border& border : borders) {
    const RegimeCrossing& crossing = border.crossing;
    if (!has_neighbour(plan, box, border) || border.element >= elements || !is_regime(crossing.below) ||
        !is_regime(crossing.above) || !(crossing.at >= 0.0 && crossing.at <= 1.0))
      throw BadEntry(fmt::format("a border at {} of point {}, dimension {}, element {}, is invalid",
                                 crossing.at, border.offset, border.dimension, border.element));
  }
}

}  // namespace

void check_entry(const MapPlan& plan, std::uint64_t tile, std::span<const std::byte> bytes) {
  const MapBox box = plan.grid.box(tile);
  const std::uint64_t points = box.points();
  thread_local TileEntry entry;  // its memory is used again: a log has many tiles
  decode(bytes, points * plan.variables.size(), entry);
  check_values(plan, entry.values, points);
  check_failed(entry.failed, points);
  const bool has_borders = plan.study.sweep() && plan.study.sweep()->borders;
  if (entry.borders.has_value() != has_borders)
    throw BadEntry(has_borders ? "it has no borders" : "it has borders, but the study has none");
  if (has_borders) check_borders(plan, *entry.borders, box);
}

bool is_possible(double value, const periodic::QuantityDescription& variable) {
  using periodic::QuantityKind;
  if (variable.kind == QuantityKind::count)
    return value >= -1.0 && value <= std::numeric_limits<std::int32_t>::max() && value == std::trunc(value);
  if (variable.kind != QuantityKind::flag || value == 0.0) return true;
  return std::ranges::any_of(variable.flags,
                             [&](const auto& flag) { return static_cast<double>(flag.second) == value; });
}

}  // namespace frahm::studies
