#include "results/data_check.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "results/store_error.hpp"

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

void check_data(const hdf5::Dataset& dataset, Completeness completeness) {
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
    if (completeness == Completeness::whole) dataset.require_chunk(box.start);
    dataset.read(box.start, box.count);
  } while (next_index(index, first, last));
}

}  // namespace

// Scales and datasets name each other. Ours are read by what the scales say, which lies under a checksum;
// other readers go by the dataset's list, which does not.
void check_scales(const hdf5::Group& group) {
  const hdf5::Group::Scales scales = group.scales();
  for (const std::string& name : group.dataset_names()) {
    const hdf5::Dataset dataset = group.dataset(name);
    if (!dataset.is_numeric() || dataset.is_scale()) continue;
    const auto listed = dataset.listed_scales();
    for (unsigned d = 0; d < listed.size(); ++d) {
      const auto scale = scales.find({dataset.address(), d});
      std::vector<std::uint64_t> expected;
      if (scale != scales.end()) expected.push_back(group.dataset(scale->second).address());
      if (listed[d] == expected) continue;
      throw StoreError(dataset.where(),
                       fmt::format("the list of its dimensions is damaged: dimension {} is {}", d + 1,
                                   scale == scales.end() ? "without a name" : scale->second),
                       "");
    }
  }
  for (const std::string& name : group.link_names()) {
    if (!group.has_dataset(name)) check_scales(group.group(name));
  }
}

void check_data(const hdf5::Group& group, Completeness completeness) {
  for (const std::string& name : group.link_names()) {
    if (group.has_dataset(name)) {
      check_data(group.dataset(name), completeness);
    } else {
      check_data(group.group(name), completeness);
    }
  }
}

}  // namespace frahm::results
