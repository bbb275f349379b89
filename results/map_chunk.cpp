#include "results/map_chunk.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "results/chunk_codec.hpp"

namespace frahm::results {
namespace {

// Throws std::invalid_argument unless `start` is the first point of a chunk of the map.
void check_start(const Shape& start, const Shape& chunk, const Shape& map) {
  bool right = start.size() == map.size();
  for (std::size_t k = 0; right && k < map.size(); ++k) right = start[k] < map[k] && start[k] % chunk[k] == 0;
  if (!right) {
    throw std::invalid_argument(
        fmt::format("chunk at {}: must begin at a multiple of {} within {}", start, chunk, map));
  }
}

}  // namespace

Shape chunk_shape(const MapLayout& layout) {
  Shape chunk = layout.chunk;
  for (std::size_t k = 0; k < chunk.size(); ++k) chunk[k] = std::min(chunk[k], layout.axes[k].size);
  return chunk;
}

MapChunk::MapChunk(const MapLayout& layout)
    : layout_(layout), whole_{.start = {}, .count = chunk_shape(layout)} {
  for (const Variable& variable : layout.variables)
    blank_.push_back(missing_elements(variable.type, product(whole_.count)));
  begin(Shape(layout.axes.size(), 0));
}

void MapChunk::begin(const Shape& start) {
  const Shape map = shape_of(layout_);
  check_start(start, whole_.count, map);
  whole_.start = start;
  within_ = common(whole_, {Shape(map.size(), 0), map});
  elements_ = blank_;
}

void MapChunk::put(std::size_t variable, const Box& block, std::span<const double> values) {
  if (variable >= elements_.size()) {
    throw std::invalid_argument(fmt::format("variable {}: must be below {}", variable, elements_.size()));
  }
  const Variable& described = layout_.variables[variable];
  if (!contains(within_, block)) {
    throw std::invalid_argument(fmt::format("{}: block of {} at {}: must lie within the chunk of {} at {}",
                                            described.name, block.count, block.start, within_.count,
                                            within_.start));
  }
  if (values.size() != product(block.count)) {
    throw std::invalid_argument(
        fmt::format("{}: {} values for a block of {}", described.name, values.size(), block.count));
  }
  if (values.empty()) return;
  copy_box(block, to_storage(described, values), block, elements_[variable], whole_,
           element_size(described.type));
}

EncodedChunk MapChunk::encoded() const {
  EncodedChunk chunk{.start = whole_.start, .variables = {}};
  for (std::size_t v = 0; v < elements_.size(); ++v)
    chunk.variables.push_back(encode_chunk(elements_[v], element_size(layout_.variables[v].type)));
  return chunk;
}

}  // namespace frahm::results
