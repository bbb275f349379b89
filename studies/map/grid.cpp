#include "studies/map/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "studies/map/motion_cost.hpp"
#include "studies/map/orbit_cost.hpp"
#include "studies/reading/quantities/unit_words.hpp"

namespace frahm::studies {
namespace {

// Sizes of tiles [points].
struct TileSizes {
  std::uint64_t longest_row;  // longer ones are cut
  std::uint64_t least, most;
};
// Smaller tiles would waste warm starts.
constexpr TileSizes cheap_tiles{.longest_row = 4000, .least = 256, .most = 2048};
constexpr std::uint64_t tiles_wanted = 128;               // of a small map, for the threads to share
constexpr std::uint64_t chunk_points_wanted = 128 * 128;  // 128 KiB of doubles

std::uint64_t product(const std::vector<std::uint64_t>& factors) {
  std::uint64_t result = 1;
  for (const std::uint64_t factor : factors) result *= factor;
  return result;
}

std::uint64_t pieces(std::uint64_t size, std::uint64_t extent) {
  return (size + extent - 1) / extent;
}

// The extent of at most `most`, and at least half of it, whose pieces cut `size` most evenly.
std::uint64_t even_extent(std::uint64_t size, std::uint64_t most) {
  if (size <= most) return size;
  std::uint64_t best = most;
  for (std::uint64_t extent = most; 2 * extent > most; --extent) {
    if (pieces(size, extent) * extent < pieces(size, best) * best) best = extent;
  }
  return best;
}

// A tile is some tenths of a second of work at most, so that all threads have some, progress moves and a stop
// is obeyed soon; of expensive points up to a second's, as each orbit starts the search for the next.
// Rows that are swept are never cut.
TileSizes sizes_of(const Study& study) {
  constexpr double kMostSeconds = 0.25, kFewestPoints = 4.0;
  const double seconds = predicted_orbit_seconds(study);
  TileSizes sizes = cheap_tiles;
  const double affordable = std::max({1.0, kMostSeconds / seconds, std::min(kFewestPoints, 1.0 / seconds)});
  if (affordable < static_cast<double>(cheap_tiles.most)) {
    const auto most = static_cast<std::uint64_t>(affordable);
    sizes = {.longest_row = most, .least = std::min(most, cheap_tiles.least), .most = most};
  }
  if (study.sweep() && study.sweep()->sweeps_frequency())
    sizes.longest_row = std::numeric_limits<std::uint64_t>::max();
  return sizes;
}

// Motions share nothing, so that their tiles may be small: some milliseconds of work, and a tile for every
// thread to take of a map of few motions.
TileSizes sizes_for_motions(const Study& study, std::uint64_t points) {
  constexpr double kFewestSeconds = 2e-3, kMostSeconds = 0.25;
  const double seconds = predicted_motion_seconds(study);
  const auto least = static_cast<std::uint64_t>(std::max(1.0, kFewestSeconds / seconds));
  const auto most = static_cast<std::uint64_t>(std::max(1.0, kMostSeconds / seconds));
  const std::uint64_t wanted = std::clamp(points / tiles_wanted, least, most);
  return {.longest_row = wanted, .least = wanted, .most = wanted};
}

void cut_into_tiles(const TileSizes& sizes, Grid& grid) {
  const std::uint64_t wanted = std::clamp(grid.points() / tiles_wanted, sizes.least, sizes.most);
  grid.tile.assign(grid.shape.size(), 1);
  const std::size_t row = grid.order.back();
  grid.tile[row] = even_extent(grid.shape[row], sizes.longest_row);
  std::uint64_t points = grid.tile[row];
  bool whole = points == grid.shape[row];
  for (auto d = grid.order.rbegin() + 1; d != grid.order.rend() && whole && 2 * points <= wanted; ++d) {
    grid.tile[*d] = even_extent(grid.shape[*d], wanted / points);
    points *= grid.tile[*d];
    whole = grid.tile[*d] == grid.shape[*d];
  }
}

// Tiles that follow each other are joined, so that few chunks are unfinished at a time when tiles come in
// order.
void join_into_chunks(Grid& grid) {
  grid.chunk = grid.tile;
  for (auto d = grid.order.rbegin(); d != grid.order.rend(); ++d) {
    const std::uint64_t most = pieces(grid.shape[*d], grid.tile[*d]);
    const std::uint64_t wanted = std::min(most, pieces(chunk_points_wanted, product(grid.chunk)));
    const std::uint64_t joined = pieces(most, pieces(most, wanted));  // no more chunks, of more even size
    grid.chunk[*d] = std::min(grid.shape[*d], grid.tile[*d] * joined);
    if (joined < most) return;
  }
}

// Boxes of the given extent that the map is cut into.
std::uint64_t boxes(const Grid& grid, const std::vector<std::uint64_t>& extent) {
  std::uint64_t result = 1;
  for (std::size_t d = 0; d < extent.size(); ++d) result *= pieces(grid.shape[d], extent[d]);
  return result;
}

// One of these boxes, numbered in the order of computation.
MapBox box_of(const Grid& grid, const std::vector<std::uint64_t>& extent, std::uint64_t number) {
  MapBox result{std::vector<std::uint64_t>(extent.size()), std::vector<std::uint64_t>(extent.size())};
  for (auto d = grid.order.rbegin(); d != grid.order.rend(); ++d) {
    const std::uint64_t along = pieces(grid.shape[*d], extent[*d]);
    result.start[*d] = number % along * extent[*d];
    result.count[*d] = std::min(extent[*d], grid.shape[*d] - result.start[*d]);
    number /= along;
  }
  return result;
}

}  // namespace

std::uint64_t MapBox::points() const {
  return product(count);
}

std::uint64_t MapBox::offset_of(std::span<const std::uint64_t> index) const {
  std::uint64_t offset = 0;
  for (std::size_t d = 0; d < index.size(); ++d) offset = offset * count[d] + (index[d] - start[d]);
  return offset;
}

std::uint64_t Grid::points() const {
  return product(shape);
}

std::uint64_t Grid::tiles() const {
  return boxes(*this, tile);
}

std::uint64_t Grid::chunks() const {
  return boxes(*this, chunk);
}

MapBox Grid::box(std::uint64_t number) const {
  return box_of(*this, tile, number);
}

MapBox Grid::chunk_box(std::uint64_t number) const {
  return box_of(*this, chunk, number);
}

std::uint64_t Grid::tile_of(std::span<const std::uint64_t> index) const {
  std::uint64_t number = 0;
  for (const std::size_t d : order) number = number * pieces(shape[d], tile[d]) + index[d] / tile[d];
  return number;
}

Grid grid_of(const Study& study) {
  Grid grid;
  for (const GridDimension& dimension : study.map()->dimensions) grid.shape.push_back(dimension.size);
  const std::size_t last = study.map()->dimensions.size() - 1;
  const std::size_t row = study.sweep() ? study.sweep()->frequency_dimension.value_or(last) : last;
  for (std::size_t d = 0; d < study.map()->dimensions.size(); ++d) {
    if (d != row) grid.order.push_back(d);
  }
  grid.order.push_back(row);
  cut_into_tiles(study.transient() ? sizes_for_motions(study, grid.points()) : sizes_of(study), grid);
  join_into_chunks(grid);
  return grid;
}

std::vector<double> coordinate_values(const Study& study, const DerivedCoordinate& coordinate) {
  std::vector<double> parameters = study.parameters.nominal();
  std::vector<double> values(study.map()->dimensions[coordinate.dimension].size);
  for (std::size_t i = 0; i < values.size(); ++i) {
    set_along(*study.map(), coordinate.dimension, i, parameters);
    study.parameters.complete(std::span<double>(parameters));
    values[i] =
        coordinate.value.expression.evaluate(std::span<const double>(parameters)) / coordinate.si_factor;
  }
  return values;
}

bool next_point(const MapBox& box, std::span<const std::size_t> dimensions,
                std::vector<std::uint64_t>& index) {
  for (auto d = dimensions.rbegin(); d != dimensions.rend(); ++d) {
    if (++index[*d] < box.start[*d] + box.count[*d]) return true;
    index[*d] = box.start[*d];
  }
  return false;
}

std::string point_text(const Study& study, std::span<const std::uint64_t> index) {
  std::string text;
  for (std::size_t d = 0; d < study.map()->dimensions.size(); ++d) {
    if (const auto& records = study.map()->records; records && records->dimension == d)
      text += fmt::format("{}record={}", text.empty() ? "" : ",", index[d]);
    for (const std::size_t a : study.map()->dimensions[d].axes) {
      const ParameterAxis& axis = study.map()->axes[a];
      text += fmt::format("{}{}={}", text.empty() ? "" : ",", study.parameters.list[axis.parameter].name,
                          with_unit(axis.values[index[d]], axis.unit));
    }
  }
  return text;
}

}  // namespace frahm::studies
