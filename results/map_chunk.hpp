#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "results/box.hpp"
#include "results/layout.hpp"
#include "results/storage.hpp"

namespace frahm::results {

// A chunk of the map, all its variables, as the file stores it. MapWriter::write_chunk() takes it.
struct EncodedChunk {
  Shape start;                   // its first point
  std::vector<Bytes> variables;  // see encode_chunk(); one for each of MapLayout::variables
};

// The shape of the chunks of a map as the file has them: no longer than its axes.
Shape chunk_shape(const MapLayout& layout);

// Assembles the chunks of a map one after another from blocks of values, and encodes them. It does not touch
// the file: threads make chunks at the same time, each with its own MapChunk.
//
// Errors: std::invalid_argument, naming the item, its value and the rule.
class MapChunk {
 public:
  explicit MapChunk(const MapLayout& layout);  // the layout must outlive it, and be checked

  // Begins the chunk whose first point is `start`, a multiple of the chunk's shape; every point is missing.
  void begin(const Shape& start);

  // values: one for each point of the block, which lies within the chunk and the map, row-major, in the
  // variable's unit; missing ones as NaN for floats, -1 for integers, 0 for flags.  variable: index into
  // MapLayout::variables. A point put twice has the later value.
  void put(std::size_t variable, const Box& block, std::span<const double> values);

  EncodedChunk encoded() const;

 private:
  const MapLayout& layout_;
  Box whole_;                    // its points, also beyond the map's edge
  Box within_;                   // its points within the map
  std::vector<Bytes> blank_;     // of each variable, a chunk of missing values
  std::vector<Bytes> elements_;  // of each variable, as stored; missing values beyond the map's edge
};

}  // namespace frahm::results
