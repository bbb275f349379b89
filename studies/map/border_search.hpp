#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "studies/map/grid.hpp"
#include "studies/map/regime_crossings.hpp"
#include "studies/map/row_solver.hpp"
#include "studies/map/tile_entry.hpp"

namespace frahm::studies {

// Finds where the regimes of the Coulomb elements change between neighbouring points of a map. For one
// thread; each has its own.
//
// An edge between two neighbours belongs to the tile of its lower one. The regimes at the neighbours beyond
// its upper faces are solved here, each row without earlier orbits, and so are those of the tile where they
// are not given. So the borders of a tile depend on the study alone, and both tiles that meet at a point see
// the same regime there.
class BorderSearch {
 public:
  // study, grid: must outlive this.  The elements follow the exact law.
  BorderSearch(const Study& study, const Grid& grid);

  // Appends the borders on the edges of a tile: those of one row of the tile after the other, in a row along
  // one dimension after the other.  known: the regimes of each element with a contact at all points of the
  // tile, one element after the other, as they are recorded; or empty, for points that are taken over.
  void find(const MapBox& tile, std::span<const std::span<const double>> known, std::vector<Border>& borders);

 private:
  using Index = std::vector<std::uint64_t>;

  bool has_neighbours(std::size_t dimension) const;
  bool is_beyond(const Index& index, std::size_t dimension) const;
  std::size_t offset_of(const Index& index) const;
  void take_regimes(std::span<const std::span<const double>> known);
  void find_regimes(bool of_tile);
  void find_regimes_of_row(Index index, bool of_tile);
  void find_regimes_of_stretch(Index index, std::uint64_t first, std::uint64_t last);
  void search_row(const Index& row, std::size_t dimension, std::vector<Border>& borders);
  std::vector<RegimeCrossing> crossings_on_edge(const Index& lower, std::size_t dimension,
                                                std::size_t element,
                                                const std::optional<CrossingForecast>& forecast);
  RegimePoint point_on_edge(const Index& lower, std::size_t dimension, std::size_t element, double at);

  const Study& study_;
  const Grid& grid_;
  std::size_t elements_ = 0;  // Coulomb elements of the network
  RowSolver solver_;          // of their regimes

  // Workspace, of the tile in hand.
  MapBox tile_, wide_;                     // wide_: with the neighbours beyond its upper faces
  std::vector<periodic::Regime> regimes_;  // of each element at each point of wide_
  std::vector<double> parameters_;         // SI
};

}  // namespace frahm::studies
