#pragma once

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "results/map_reader.hpp"
#include "tests/end_to_end/runs.hpp"

// Runs with --from, and what their results are held against.
namespace grown_maps {

inline runs::Outcome run(const std::string& study, const std::string& output,
                         const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"run", study, "-o", output, "--threads", "2", "--progress", "none"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return runs::frahm(arguments);
}

inline std::string provenance(const std::string& path, const std::string& name) {
  for (const auto& [key, text] : frahm::results::MapReader(path).texts("provenance")) {
    if (key == name) return text;
  }
  return "none";
}

// What the table of a run says of its points.
struct Points {
  long reused = -1, computed = -1;
  friend bool operator==(const Points&, const Points&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Points& points) {
    return out << points.reused << " reused, " << points.computed << " computed";
  }
};

inline Points points_of(const std::string& table) {
  const std::size_t line = table.find("\nreused ");
  if (line == std::string::npos) return {};
  const std::size_t computed = table.find(", ", line);
  return {std::stol(table.substr(line + 8)), std::stol(table.substr(computed + 2))};
}

inline bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

inline std::size_t variable_size(const runs::Map& map) {
  return map.values.begin()->second.size();
}

// Whether a point of one map is, in every variable, the same to the last bit as one of the other.
inline bool same_point(const runs::Map& a, std::size_t i, const runs::Map& b, std::size_t j) {
  return std::ranges::all_of(a.values, [&](const auto& variable) {
    return same(variable.second[i], b.values.at(variable.first)[j]);
  });
}

}  // namespace grown_maps
