#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "studies/reading/quantities/dual.hpp"

namespace frahm::studies {

// y(x), linear between points of strictly increasing x; NaN outside them. At a point the slope is that of the
// piece on its right (at the last point, on its left).
struct LookupTable {
  std::vector<double> x, y;  // of the same size, at least 2

  double at(double value) const { return at(Dual{value, 0.0}).value; }
  Dual at(const Dual& value) const;
};

inline Dual LookupTable::at(const Dual& value) const {
  if (!(value.value >= x.front() && value.value <= x.back())) {
    return {kNone, kNone};
  }
  const auto right = std::upper_bound(x.begin() + 1, x.end() - 1, value.value);
  const auto i = static_cast<std::size_t>(right - x.begin());
  const double part = (value.value - x[i - 1]) / (x[i] - x[i - 1]);
  const double slope = (y[i] - y[i - 1]) / (x[i] - x[i - 1]);
  return {std::lerp(y[i - 1], y[i], part), slope * value.derivative};
}

// A table with what its header says of its columns: "x [mm]".
struct ReadTable {
  LookupTable table;
  std::optional<std::string> x_unit, y_unit;
};

// Reads the two columns x, y of a CSV file. Columns are separated by comma, semicolon or tab; a first row
// that is not numeric is a header; empty lines and lines that start with # do not count. Throws StudyError
// with file and line for anything else, for x that does not increase and for less than two rows.
ReadTable read_lookup_table(const std::filesystem::path& path);

}  // namespace frahm::studies
