#include "studies/program/listing.hpp"

#include <numeric>

namespace frahm::studies {

std::vector<std::size_t> listed_indices(std::size_t count, std::size_t most, Listing listing) {
  const bool is_whole = listing == Listing::whole || count <= most;
  std::vector<std::size_t> indices(is_whole ? count : most);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  if (is_whole) return indices;
  for (std::size_t& i : indices) i = (i * (count - 1) + (most - 1) / 2) / (most - 1);
  return indices;
}

}  // namespace frahm::studies
