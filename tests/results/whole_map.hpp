#pragma once

#include <span>
#include <vector>

#include "results/map_chunk.hpp"
#include "results/map_writer.hpp"

// Writes a map that is one chunk. values: of each variable, row-major.
inline void write_whole_map(frahm::results::MapWriter& writer, const frahm::results::MapLayout& layout,
                            const std::vector<std::vector<double>>& values) {
  frahm::results::Shape shape;
  for (const auto& axis : layout.axes) shape.push_back(axis.size);
  frahm::results::MapChunk chunk(layout);
  for (std::size_t v = 0; v < values.size(); ++v)
    chunk.put(v, {frahm::results::Shape(shape.size(), 0), shape}, values[v]);
  writer.write_chunk(chunk.encoded());
}
