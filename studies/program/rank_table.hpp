#pragma once

#include <iosfwd>

#include "studies/map/map_sample.hpp"

namespace frahm::studies {

// Prints the predicted time of a map on 1, 10, 100 ... up to `ranks` ranks, by a replay of the dealing of
// tiles, and the causes of lost time.  threads: of each rank.  start_seconds: until a rank has read the
// study. Throws StudyError for more threads in all than can be replayed.
void print_rank_table(const Grid& grid, const MapSample& sample, int ranks, int threads, double start_seconds,
                      std::ostream& out);

}  // namespace frahm::studies
