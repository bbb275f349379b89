#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/bytes.hpp"
#include "studies/map/border_search.hpp"
#include "studies/map/grid.hpp"
#include "studies/map/open_tile.hpp"
#include "studies/map/row_solver.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

class KnownPoints;

// Computes the tiles of a study's map: at each point the quantities of the periodic response and of the
// response compared with it, and where regimes change. A point without a response fails with a reason; it
// never ends the work. For one thread; each has its own.
//
// Each tile starts from nothing and goes through its rows in a fixed order, each orbit that needs a start
// starting from those computed before it, so that the record of a tile depends on the tile alone, and on the
// earlier result from which the map grows.
class MapKernel {
 public:
  // study, grid, earlier: must outlive the kernel.  earlier: the points it has are not computed; may be null.
  MapKernel(const Study& study, const Grid& grid, std::vector<periodic::Quantity> quantities,
            KnownPoints* earlier = nullptr);

  // Appends the entry of a tile (tile_entry.hpp) to `out`.
  void operator()(std::uint64_t tile, engine::Bytes& out);

 private:
  void compute_row(const MapBox& box);
  bool is_row_known(std::uint64_t offset, std::uint64_t step, std::uint64_t count) const;
  std::vector<std::span<const double>> regimes_of_tile() const;
  void record_point(std::size_t i, std::uint64_t offset);

  const Study& study_;
  const Grid& grid_;
  std::size_t quantities_;                         // of the study's own record
  std::vector<std::size_t> compared_;              // index of each compared quantity among those solved for
  std::vector<std::optional<std::size_t>> sizes_;  // likewise, of size_of_compared()
  OpenTile tile_;
  RowSolver own_;
  std::optional<RowSolver> other_;
  std::optional<BorderSearch> border_search_;
  std::vector<std::size_t> regimes_;  // index of each contact's regime among the quantities, for the borders

  // Workspace, of the tile, the row and the point in hand.
  std::vector<std::uint64_t> index_;    // of the row's first point
  std::vector<std::uint64_t> offsets_;  // of the points of the row that are computed
  std::vector<double> parameters_;      // SI
  std::vector<double> point_;           // its variables
  std::vector<double> own_compared_;    // of the study's response, those that are compared
  std::vector<double> own_sizes_;       // by which they are distinguished from nothing
};

}  // namespace frahm::studies
