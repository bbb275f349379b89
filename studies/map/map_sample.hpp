#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "studies/map/map_plan.hpp"
#include "studies/map/rank_simulation.hpp"

namespace frahm::studies {

// Cost and size of a sample of tiles, evenly spread over a map.
struct MapSample {
  std::uint64_t points = 0;        // computed, >= 1
  double seconds = 0.0;            // of one thread
  std::vector<TileCost> costs;     // of each tile computed, or of which a point was
  std::uint64_t raw_bytes = 0;     // of their values in the record
  std::uint64_t stored_bytes = 0;  // the same, compressed
  double encoding_seconds = 0.0;   // what the compression took one thread
  std::uint64_t failed = 0;        // points
  std::string failed_at, reason;   // of the first that failed; its point as --at takes it
};

// Computes tiles of the map until `seconds` have passed or all are done; at least one, and up to eight within
// four times `seconds`. Of tiles that take seconds each only the first point is computed. Throws
// mechanics::MechanicsError for a network that cannot move at any values.
MapSample sample_map(const MapPlan& plan, double seconds);

}  // namespace frahm::studies
