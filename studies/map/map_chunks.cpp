#include "studies/map/map_chunks.hpp"

#include <algorithm>

namespace frahm::studies {

void for_each_chunk(const results::MapLayout& layout, const std::function<void(const MapBox&)>& visit) {
  const std::size_t rank = layout.axes.size();
  MapBox box{std::vector<std::uint64_t>(rank, 0), std::vector<std::uint64_t>(rank)};
  for (bool more = true; more;) {
    for (std::size_t d = 0; d < rank; ++d) {
      box.count[d] = std::min(layout.chunk[d], layout.axes[d].size - box.start[d]);
    }
    visit(box);
    more = false;
    for (std::size_t d = rank; d-- > 0 && !more;) {
      box.start[d] += layout.chunk[d];
      more = box.start[d] < layout.axes[d].size;
      if (!more) box.start[d] = 0;
    }
  }
}

}  // namespace frahm::studies
