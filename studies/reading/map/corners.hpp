#pragma once

#include <cstddef>
#include <vector>

namespace frahm::studies {

// The corners of a box: true marks the upper end of a dimension. For many dimensions, only the lowest and the
// highest corner and those that differ from either in one dimension.
std::vector<std::vector<bool>> corners(std::size_t dimensions);

}  // namespace frahm::studies
