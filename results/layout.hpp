#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

// What a result file holds, in the words of its readers: axes, coordinates, variables. See FORMAT.md.
namespace frahm::results {

// How a variable is stored, and its value where nothing was computed.
enum class Type {
  float64,  // NaN
  float32,  // NaN
  int64,    // -1; the index of a dimension and the starts of ragged rows
  int32,    // -1; counts
  flag,     // 0 = not_computed; int8 with named values
};

struct Flag {
  std::string meaning;  // one word, e.g. "non_stop"
  int value = 0;        // 0 to 127
};

struct Variable {
  std::string name;       // [A-Za-z][A-Za-z0-9_]*
  std::string unit = {};  // UDUNITS form ("rad s-1", "m", "1"); empty for flags only
  std::string long_name = {};
  Type type = Type::float64;
  std::vector<Flag> flags = {};  // for Type::flag only; the first is {"not_computed", 0}
  int significant_bits = 0;      // to which a float was rounded, after the first; 0: all
};

// A coordinate of the map, float64.
struct Coordinate {
  std::string name;
  std::string unit;  // UDUNITS form
  std::string long_name;
  std::vector<double> values;           // finite, one for each point of the axis
  std::vector<std::string> names = {};  // of the values, without line breaks; empty: they have none
};

// One dimension of the map. A coordinate named like the axis is the data of its dimension scale; without one
// (axes zipped together, named by their group) the scale is the index 0, 1, ... The other coordinates, zipped
// parameters and derived ones such as a frequency ratio, are variables along the axis.
struct Axis {
  std::string name;
  std::uint64_t size = 0;
  std::vector<Coordinate> coordinates = {};
};

struct MapLayout {
  std::string title = {}, source = {}, history = {};
  std::vector<Axis> axes = {};            // slowest first
  std::vector<Variable> variables = {};   // each on all axes
  std::vector<std::uint64_t> chunk = {};  // shape of a chunk [points], one for each axis, clipped to the axis
};

std::vector<std::uint64_t> shape_of(const MapLayout& layout);  // the sizes of its axes

// One variable of a group, such as /optimum or /decay, with all its values.
struct Column {
  Variable variable;
  std::string dimension = {};       // of the group; empty for a single number
  std::vector<double> values = {};  // the missing value of the type where not computed (see Type)
};

// A group of rows that arrive one by one, each with its own number of samples: the recorded orbits (row =
// "orbit", sample = "sample") or, without samples, the regime borders (row = "border").
struct RaggedLayout {
  std::string group;
  std::string row;                           // dimension of the rows
  std::vector<Variable> row_variables = {};  // one number a row
  std::string sample = {};                   // dimension of the samples of all rows, end to end; empty: none
  std::vector<Variable> sample_variables = {};
};

using Text = std::pair<std::string, std::string>;  // name, value in UTF-8

// All of a group without rows of its own.
struct GroupContent {
  std::string path;  // "optimum", "optimum/front"
  std::vector<Column> columns = {};
  std::vector<Text> texts = {};
};

// These throw std::invalid_argument, naming the item, its value and the rule, for contents that some reader
// could not open.
void check(const MapLayout&);
void check(const RaggedLayout&);
void check(const std::vector<Column>&);

}  // namespace frahm::results
