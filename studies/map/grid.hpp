#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "studies/reading/study/study.hpp"

// The points of a map and its tiles: groups of points computed and saved as a whole. Both depend on the study
// alone, never on who computes them.
namespace frahm::studies {

// The points start <= index < start + count along each dimension of the map, slowest first.
struct MapBox {
  std::vector<std::uint64_t> start, count;

  std::uint64_t points() const;
  // The offset of a point within the box, in row-major order.  index: in the map.
  std::uint64_t offset_of(std::span<const std::uint64_t> index) const;
};

struct Grid {
  // One number for each dimension of the map, slowest first:
  std::vector<std::uint64_t> shape;  // points
  std::vector<std::uint64_t> tile;   // points of a tile; the last ones are cut off at the map's edge
  std::vector<std::uint64_t> chunk;  // points of a chunk of the record, a union of whole tiles

  // The dimensions in the order of computation: the last one, the frequency where there is one, runs
  // innermost and is a row.
  std::vector<std::size_t> order;

  // The dimensions across the rows: all but the last.
  std::span<const std::size_t> row_dimensions() const { return std::span(order).first(order.size() - 1); }

  std::uint64_t points() const;
  std::uint64_t tiles() const;

  std::uint64_t chunks() const;

  // The points of a tile. Tiles are numbered in the order of computation.  tile: below tiles().
  MapBox box(std::uint64_t tile) const;

  // The points of a chunk. Chunks are numbered in the order of their tiles: the tiles of a chunk are
  // consecutive.  chunk: below chunks().
  MapBox chunk_box(std::uint64_t chunk) const;

  // The tile that holds a point.  index: one number for each dimension of the map.
  std::uint64_t tile_of(std::span<const std::uint64_t> index) const;
};

// A tile holds whole rows, as many as make a few hundred to two thousand points; rows longer than 4000 are
// cut. Where a point takes more than a tenth of a millisecond (orbit_cost.hpp), it holds fewer points, of a
// part of a row. Where the frequency is swept, rows are whole.
Grid grid_of(const Study& study);

// The values of a derived coordinate along its dimension.
std::vector<double> coordinate_values(const Study& study, const DerivedCoordinate& coordinate);

// Moves `index` to the next point of the box along `dimensions`, the last of which runs fastest; after its
// last point false, with `index` back at the start.
bool next_point(const MapBox& box, std::span<const std::size_t> dimensions,
                std::vector<std::uint64_t>& index);

// A point as the option --at takes it, each value in the unit of its axis: "I=4.72 kg,FP=0.1,omega=250 rpm".
// index: one number for each dimension of the map.
std::string point_text(const Study& study, std::span<const std::uint64_t> index);

}  // namespace frahm::studies
