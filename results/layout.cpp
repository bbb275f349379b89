#include "results/layout.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

namespace frahm::results {
namespace {

// A chunk is compressed in one piece whose size must fit 32 bits (HDF5 and deflate); 2^28 points of 8 bytes
// fit.
constexpr std::uint64_t max_chunk_points = std::uint64_t{1} << 28;

template <typename... Args>
[[noreturn]] void refuse(fmt::format_string<Args...> text, Args&&... args) {
  throw std::invalid_argument(fmt::format(text, std::forward<Args>(args)...));
}

// The names within one group of the file: each well formed and used once.
class Names {
 public:
  void add(const std::string& name) {
    const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
    const auto is_inner = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
    if (name.empty() || !is_letter(name.front()) || !std::all_of(name.begin(), name.end(), is_inner)) {
      refuse("name '{}': must match [A-Za-z][A-Za-z0-9_]*", name);
    }
    if (!seen_.insert(name).second) refuse("name '{}': must be used once in its group", name);
  }

 private:
  std::set<std::string> seen_;
};

void check_flags(const Variable& variable) {
  if (variable.flags.empty() || variable.flags.front().meaning != "not_computed" ||
      variable.flags.front().value != 0) {
    refuse("variable '{}': its first flag must be not_computed = 0", variable.name);
  }
  std::set<int> values;
  Names meanings;
  for (const Flag& flag : variable.flags) {
    meanings.add(flag.meaning);
    if (flag.value < 0 || flag.value > 127 || !values.insert(flag.value).second) {
      refuse("variable '{}': flag {} = {}: must be in 0..127 and used once", variable.name, flag.meaning,
             flag.value);
    }
  }
}

void check_variable(const Variable& variable, Names& names) {
  names.add(variable.name);
  if (variable.long_name.empty()) refuse("variable '{}': must have a long_name", variable.name);
  const bool is_flag = variable.type == Type::flag;
  if (variable.unit.empty() != is_flag) {
    refuse("variable '{}': unit '{}': must be given, except for a flag", variable.name, variable.unit);
  }
  if (is_flag) {
    check_flags(variable);
  } else if (!variable.flags.empty()) {
    refuse("variable '{}': flags are for Type::flag only", variable.name);
  }
}

void check_axis(const Axis& axis, Names& names) {
  if (axis.size == 0) refuse("axis '{}': size 0: must be at least 1", axis.name);
  names.add(axis.name);
  for (const Coordinate& coordinate : axis.coordinates) {
    if (coordinate.name != axis.name) names.add(coordinate.name);
    if (coordinate.unit.empty()) refuse("coordinate '{}': must have a unit", coordinate.name);
    if (coordinate.long_name.empty()) refuse("coordinate '{}': must have a long_name", coordinate.name);
    if (coordinate.values.size() != axis.size) {
      refuse("coordinate '{}': {} values: must be {}, the size of axis '{}'", coordinate.name,
             coordinate.values.size(), axis.size, axis.name);
    }
    for (const double value : coordinate.values) {
      if (!std::isfinite(value)) refuse("coordinate '{}': value {}: must be finite", coordinate.name, value);
    }
  }
  const auto own = [&](const Coordinate& coordinate) { return coordinate.name == axis.name; };
  if (std::count_if(axis.coordinates.begin(), axis.coordinates.end(), own) > 1) {
    refuse("axis '{}': must have one coordinate of its own name at most", axis.name);
  }
}

}  // namespace

std::vector<std::uint64_t> shape_of(const MapLayout& layout) {
  std::vector<std::uint64_t> shape;
  for (const Axis& axis : layout.axes) shape.push_back(axis.size);
  return shape;
}

void check(const MapLayout& layout) {
  Names names;
  for (const Axis& axis : layout.axes) check_axis(axis, names);
  for (const Variable& variable : layout.variables) check_variable(variable, names);
  if (layout.axes.empty() && !layout.variables.empty()) {
    refuse("variable '{}': a map without axes has no variables", layout.variables.front().name);
  }
  if (layout.chunk.size() != layout.axes.size()) {
    refuse("chunk of {} dimensions: must be {}, the number of axes", layout.chunk.size(), layout.axes.size());
  }
  double points = 1.0;
  for (std::size_t k = 0; k < layout.axes.size(); ++k) {
    points *= static_cast<double>(std::min(layout.chunk[k], layout.axes[k].size));
  }
  if (points < 1.0 || points > static_cast<double>(max_chunk_points)) {
    refuse("chunk {} of {} points: must have 1 to {}", layout.chunk, points, max_chunk_points);
  }
}

void check(const RaggedLayout& layout) {
  Names().add(layout.group);
  Names names;
  names.add(layout.row);
  for (const Variable& variable : layout.row_variables) check_variable(variable, names);
  if (layout.sample.empty()) {
    if (!layout.sample_variables.empty()) refuse("group '{}': samples must have a dimension", layout.group);
    return;
  }
  names.add("row_start");
  names.add(layout.sample);
  for (const Variable& variable : layout.sample_variables) check_variable(variable, names);
}

void check(const std::vector<Column>& columns) {
  Names names;
  std::map<std::string, std::size_t> sizes;
  for (const Column& column : columns) {
    check_variable(column.variable, names);
    const std::size_t size =
        column.dimension.empty() ? 1 : sizes.emplace(column.dimension, column.values.size()).first->second;
    if (column.values.size() != size) {
      refuse("variable '{}': {} values: must be {} along '{}'", column.variable.name, column.values.size(),
             size, column.dimension);
    }
  }
  // A dimension has a column of its own name along it, or gets an index of that name.
  for (const auto& along : sizes) {
    const std::string& dimension = along.first;
    const auto clash = [&](const Column& c) {
      return c.variable.name == dimension && c.dimension != dimension;
    };
    if (std::any_of(columns.begin(), columns.end(), clash)) {
      refuse("variable '{0}': must lie along dimension '{0}'", dimension);
    }
    Names().add(dimension);
  }
}

}  // namespace frahm::results
