#pragma once

#include <vector>

#include "engine/tile_index.hpp"
#include "studies/map/beside_samples.hpp"
#include "studies/map/map_groups.hpp"

namespace frahm::studies {

// Whether the statistics of a quantity over samples are recorded: of every number but a phase, which has no
// mean.
bool has_statistics(const periodic::QuantityDescription& quantity);

// The variables of /statistics: of each such quantity mean, deviation and quantiles with their intervals, and
// the number of samples with a value.
std::vector<results::Variable> statistics_variables(const MapPlan& plan);

// What a thread holds while it makes the statistics of a map [bytes]; 0 for a map without samples.
double statistics_memory(const MapPlan& plan);

// The statistics over the samples at every point of the other axes, from the finished tiles, written to
// /statistics; nothing for a map without samples. Memory is bounded: 64 MB a thread, and one tile. Where the
// samples of a tile's points need more, its quantities are taken in several passes over the tiles.
// Throws AssemblyStopped.
void write_statistics(const MapPlan& plan, const results::MapLayout& map, const engine::TileIndex& index,
                      const AssemblyOptions& options, results::MapWriter& writer);

}  // namespace frahm::studies
