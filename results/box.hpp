#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

// Boxes of points of a row-major grid.
namespace frahm::results {

using Shape = std::vector<std::uint64_t>;

std::uint64_t product(std::span<const std::uint64_t> shape);  // 1 for rank 0

// The points start <= index < start + count, axis by axis, slowest first.
struct Box {
  Shape start, count;
};

// Whether `inner` has the rank of `outer` and lies within it.
bool contains(const Box& outer, const Box& inner);

// Throws std::invalid_argument, naming `what`, unless the box has the rank of a grid of `shape` and lies
// within it.
void check_within(const std::string& what, const Box& box, const Shape& shape);

Box common(const Box& a, const Box& b);  // of boxes that overlap

// Moves `index` to the next point of the box first <= index <= last in row-major order; false after its last
// point.
bool next_index(Shape& index, const Shape& first, const Shape& last);

// Copies the elements of `part`, rank >= 1, from the array of one box to the array of another. Both
// boxes contain `part`.
void copy_box(const Box& part, std::span<const std::byte> from, const Box& from_box, std::span<std::byte> to,
              const Box& to_box, std::size_t element_size);

}  // namespace frahm::results
