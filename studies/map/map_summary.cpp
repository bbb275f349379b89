#include "studies/map/map_summary.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "results/store_error.hpp"
#include "solvers/algebra/no_value.hpp"
#include "studies/map/grid.hpp"
#include "studies/map/map_chunks.hpp"
#include "studies/reading/quantities/unit_words.hpp"
#include "studies/reading/text/decimal_digits.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t most_rows = 12;

FlagCounts count_flag(const results::MapReader& map, std::size_t variable) {
  const results::Variable& flag = map.layout().variables[variable];
  std::vector<std::uint64_t> counts(128);
  for_each_chunk(map.layout(), [&](const MapBox& box) {
    for (const double value : map.read(variable, box.start, box.count)) {
      if (value < 0)
        throw results::StoreError(flag.name, fmt::format("holds {}: a flag is from 0 to 127", value), "");
      ++counts[static_cast<std::size_t>(value)];
    }
  });
  FlagCounts result{.variable = flag.name, .counts = {}};
  for (const results::Flag& each : flag.flags) {
    const std::uint64_t count = counts[static_cast<std::size_t>(each.value)];
    if (count > 0) result.counts.emplace_back(each.meaning, count);
  }
  return result;
}

// "omega=238.5 rpm"; of axes that advance together the index: "design=3".
std::string place_text(const results::Axis& axis, std::uint64_t index) {
  for (const results::Coordinate& coordinate : axis.coordinates) {
    if (coordinate.name == axis.name) {
      return fmt::format("{}={}", axis.name,
                         with_unit(to_digits(coordinate.values[index], 6), coordinate.unit));
    }
  }
  return fmt::format("{}={}", axis.name, index);
}

}  // namespace

PointsAboveZero points_above_zero(const results::MapReader& map, const std::string& variable) {
  const auto& variables = map.layout().variables;
  const auto found = std::ranges::find(variables, variable, &results::Variable::name);
  PointsAboveZero result;
  if (found == variables.end()) return result;
  for_each_chunk(map.layout(), [&](const MapBox& box) {
    for (const double value :
         map.read(static_cast<std::size_t>(found - variables.begin()), box.start, box.count)) {
      if (!(value > 0.0)) continue;
      ++result.points;
      result.sum += static_cast<std::uint64_t>(value);
    }
  });
  return result;
}

std::uint64_t FlagCounts::of(const std::string& meaning) const {
  const auto found = std::ranges::find(counts, meaning, &std::pair<std::string, std::uint64_t>::first);
  return found == counts.end() ? 0 : found->second;
}

const char* answers_noun(const Study& study) {
  return study.transient() ? "motions" : "orbits";
}

std::uint64_t points_of(const results::MapLayout& layout) {
  std::uint64_t points = 1;
  for (const results::Axis& axis : layout.axes) points *= axis.size;
  return points;
}

std::vector<FlagCounts> count_flags(const results::MapReader& map) {
  std::vector<FlagCounts> result;
  const auto& variables = map.layout().variables;
  for (std::size_t v = 0; v < variables.size(); ++v) {
    if (variables[v].type == results::Type::flag) result.push_back(count_flag(map, v));
  }
  return result;
}

WorstAlongAxis worst_along_slowest_axis(const results::MapReader& map, std::size_t variable) {
  WorstAlongAxis result{.variable = variable, .rows = {}};
  result.rows.resize(map.layout().axes.front().size, {kNone, {}});
  std::vector<std::size_t> dimensions(map.layout().axes.size());
  for (std::size_t d = 0; d < dimensions.size(); ++d) dimensions[d] = d;
  for_each_chunk(map.layout(), [&](const MapBox& box) {
    const std::vector<double> values = map.read(variable, box.start, box.count);
    std::vector<std::uint64_t> index = box.start;
    for (const double value : values) {
      WorstAlongAxis::Row& row = result.rows[index.front()];
      if (value > row.worst || (std::isnan(row.worst) && !std::isnan(value))) row = {value, index};
      next_point(box, dimensions, index);
    }
  });
  return result;
}

void print_flags(const std::vector<FlagCounts>& flags, std::uint64_t points, std::ostream& out) {
  for (const FlagCounts& flag : flags) {
    fmt::print(out, "{:<22}", flag.variable);
    std::string text;
    for (const auto& [meaning, count] : flag.counts) {
      const double share = 100.0 * static_cast<double>(count) / static_cast<double>(points);
      text += fmt::format("{}{} {} ({:.3g} %)", text.empty() ? "" : ", ", meaning, count, share);
    }
    fmt::print(out, " {}\n", text);
  }
}

void print_worst(const results::MapReader& map, const WorstAlongAxis& worst, std::ostream& out) {
  const results::MapLayout& layout = map.layout();
  const results::Variable& variable = layout.variables[worst.variable];
  const std::size_t rows = worst.rows.size(), shown = std::min(rows, most_rows);
  fmt::print(out, "worst {} along {}", variable.name, layout.axes.front().name);
  if (shown < rows) fmt::print(out, " ({} of {} rows, evenly chosen)", shown, rows);
  fmt::print(out, "\n");
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t at = shown > 1 ? (i * (rows - 1) + (shown - 1) / 2) / (shown - 1) : 0;
    const WorstAlongAxis::Row& row = worst.rows[at];
    fmt::print(out, "  {:<20}", place_text(layout.axes.front(), at));
    if (std::isnan(row.worst)) {
      fmt::print(out, " no value\n");
      continue;
    }
    fmt::print(out, " {:<14}", with_unit(to_digits(row.worst, 6), variable.unit));
    for (std::size_t d = 1; d < layout.axes.size(); ++d) {
      fmt::print(out, " {} {}", d == 1 ? "at" : "  ", place_text(layout.axes[d], row.index[d]));
    }
    fmt::print(out, "\n");
  }
}

}  // namespace frahm::studies
