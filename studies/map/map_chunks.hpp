#pragma once

#include <functional>

#include "results/layout.hpp"
#include "studies/map/grid.hpp"

namespace frahm::studies {

// Calls visit for every chunk of a map, cut off at the map's edge, in row-major order. Memory is bounded for
// maps of any size.
void for_each_chunk(const results::MapLayout& layout, const std::function<void(const MapBox&)>& visit);

}  // namespace frahm::studies
