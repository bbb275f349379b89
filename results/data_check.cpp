#include "results/data_check.hpp"

#include <algorithm>

namespace frahm::results {
namespace {

// The box of a chunk, cut off at the end of the dataset.  index: of the chunk along each dimension.
Box box_of_chunk(const Shape& index, const Shape& chunk, const Shape& shape) {
  Box box{Shape(shape.size()), Shape(shape.size())};
  for (std::size_t d = 0; d < shape.size(); ++d) {
    box.start[d] = index[d] * chunk[d];
    box.count[d] = std::min(chunk[d], shape[d] - box.start[d]);
  }
  return box;
}

void check_data(const hdf5::Dataset& dataset) {
  const Shape shape = dataset.shape(), chunk = dataset.chunk();
  if (!dataset.is_numeric() || product(shape) == 0) return;
  if (chunk.empty()) {
    dataset.read_all();
    return;
  }
  const Shape first(shape.size(), 0);
  Shape last(shape.size()), index = first;
  for (std::size_t d = 0; d < shape.size(); ++d) last[d] = (shape[d] - 1) / chunk[d];
  do {
    const Box box = box_of_chunk(index, chunk, shape);
    dataset.read(box.start, box.count);
  } while (next_index(index, first, last));
}

}  // namespace

void check_data(const hdf5::Group& group) {
  for (const std::string& name : group.link_names()) {
    if (group.has_dataset(name)) {
      check_data(group.dataset(name));
    } else {
      check_data(group.group(name));
    }
  }
}

}  // namespace frahm::results
