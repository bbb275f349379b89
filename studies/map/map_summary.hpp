#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

#include "results/map_reader.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// A count over a map: at how many points it is above 0, and its sum there.
struct PointsAboveZero {
  std::uint64_t points = 0, sum = 0;
};
// Nothing where the map does not have the variable.
PointsAboveZero points_above_zero(const results::MapReader& map, const std::string& variable);

// How often each value of a flag occurs on a map, those that do not occur left out.
struct FlagCounts {
  std::string variable;
  std::vector<std::pair<std::string, std::uint64_t>> counts;  // meaning, points

  std::uint64_t of(const std::string& meaning) const;
};

// The largest value of a variable at each point of the slowest axis.
struct WorstAlongAxis {
  struct Row {
    double worst = 0.0;                // NaN where nothing was computed
    std::vector<std::uint64_t> index;  // of the point
  };
  std::size_t variable = 0;  // in the layout
  std::vector<Row> rows;
};

// Counts of every flag of the map, read chunk by chunk. Throws results::StoreError.
std::vector<FlagCounts> count_flags(const results::MapReader& map);

// variable: index of a float in the layout. Throws results::StoreError.
WorstAlongAxis worst_along_slowest_axis(const results::MapReader& map, std::size_t variable);

// Tables of these for readers; of the rows at most twelve, evenly chosen.
void print_flags(const std::vector<FlagCounts>& flags, std::uint64_t points, std::ostream& out);
void print_worst(const results::MapReader& map, const WorstAlongAxis& worst, std::ostream& out);

// What is computed at the points of a study's map: "orbits" or "motions".
const char* answers_noun(const Study& study);

std::uint64_t points_of(const results::MapLayout& layout);

}  // namespace frahm::studies
