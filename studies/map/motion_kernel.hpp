#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/bytes.hpp"
#include "engine/run.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/map/open_tile.hpp"

namespace frahm::studies {

// Computes the tiles of a map of motions, each point a motion of its own from its initial values: the record
// of a tile depends on the tile alone, and on the earlier result from which the map grows. A motion that
// cannot be computed is a point that fails with a reason. For one thread; each has its own.
class MotionKernel {
 public:
  // plan, earlier: must outlive the kernel.  stop_asked: within a motion too; a tile is then given up.
  // earlier: the points it has are not computed; may be null.
  MotionKernel(const MapPlan& plan, engine::StopAsked stop_asked, KnownPoints* earlier = nullptr);

  // Appends the entry of a tile (tile_entry.hpp) to `out`. Throws engine::GivenUp.
  void operator()(std::uint64_t tile, engine::Bytes& out);

 private:
  // Sets values_ of the point at index_. Returns why it fails; empty: it does not.
  std::string compute_point();
  transient::ForcedOptions options_of_point() const;

  const MapPlan& plan_;
  engine::StopAsked stop_asked_;
  OpenTile tile_;

  // For the point in hand.
  std::vector<std::uint64_t> index_;
  std::vector<double> parameters_;  // SI
  std::vector<double> values_;      // of the variables
};

}  // namespace frahm::studies
