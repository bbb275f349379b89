#include "results/box.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace frahm::results {
namespace {

// Position of a point in an array that holds the points of `box`.
std::uint64_t position(const Box& box, const Shape& point) {
  std::uint64_t at = 0;
  for (std::size_t k = 0; k < point.size(); ++k) at = at * box.count[k] + (point[k] - box.start[k]);
  return at;
}

}  // namespace

std::uint64_t product(std::span<const std::uint64_t> shape) {
  std::uint64_t size = 1;
  for (const std::uint64_t n : shape) size *= n;
  return size;
}

bool contains(const Box& outer, const Box& inner) {
  bool inside = inner.start.size() == outer.start.size() && inner.count.size() == outer.start.size();
  for (std::size_t k = 0; inside && k < outer.start.size(); ++k) {
    const std::uint64_t from = inner.start[k] - outer.start[k];
    inside =
        inner.start[k] >= outer.start[k] && from <= outer.count[k] && inner.count[k] <= outer.count[k] - from;
  }
  return inside;
}

void check_within(const std::string& what, const Box& box, const Shape& shape) {
  if (contains({Shape(shape.size(), 0), shape}, box)) return;
  throw std::invalid_argument(
      fmt::format("{}: block of {} at {}: must lie within {}", what, box.count, box.start, shape));
}

Box common(const Box& a, const Box& b) {
  Box box = a;
  for (std::size_t k = 0; k < a.start.size(); ++k) {
    box.start[k] = std::max(a.start[k], b.start[k]);
    box.count[k] = std::min(a.start[k] + a.count[k], b.start[k] + b.count[k]) - box.start[k];
  }
  return box;
}

bool next_index(Shape& index, const Shape& first, const Shape& last) {
  for (std::size_t k = index.size(); k-- > 0;) {
    if (index[k] < last[k]) {
      ++index[k];
      return true;
    }
    index[k] = first[k];
  }
  return false;
}

void copy_box(const Box& part, std::span<const std::byte> from, const Box& from_box, std::span<std::byte> to,
              const Box& to_box, std::size_t element_size) {
  // One memcpy for each row along the fastest axis.
  const Shape& first = part.start;
  Shape last = part.start;
  for (std::size_t k = 0; k + 1 < last.size(); ++k) last[k] += part.count[k] - 1;
  Shape row = first;
  do {
    std::memcpy(to.data() + position(to_box, row) * element_size,
                from.data() + position(from_box, row) * element_size, part.count.back() * element_size);
  } while (next_index(row, first, last));
}

}  // namespace frahm::results
