#pragma once

#include <cstddef>
#include <vector>

namespace frahm::studies {

// How much of a large system a text shows: an excerpt that fits a screen, or everything (--all).
enum class Listing { excerpt, whole };

// At most `most` (at least 2) of the indices below `count`, from the first to the last, evenly chosen; all of
// a whole listing.
std::vector<std::size_t> listed_indices(std::size_t count, std::size_t most, Listing listing);

}  // namespace frahm::studies
