#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/tile_index.hpp"
#include "solvers/branches/coexisting_branches.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/map/tile_entry.hpp"

// The rows of a map through which branches are followed ([output] branches).
namespace frahm::studies {

// The first point of each row: an index along each dimension of the map, 0 along the branches' own, the last
// dimension runs fastest. The study has branches.
std::vector<std::vector<std::uint64_t>> branch_rows(const Study& study);

// The numbers of the study's network along one of its parameters, the others as given [SI]. The study must
// outlive them.
periodic::ValuesAlong values_along(const Study& study, const std::vector<double>& parameters,
                                   std::size_t along);

// The branches of one row.
class RowBranches {
 public:
  // The plan must outlive it.
  explicit RowBranches(const MapPlan& plan);

  const std::vector<periodic::Quantity>& quantities() const { return quantities_; }

  // The points of a row at which stable orbits are searched, with the number that the map has there (where it
  // records it); without those of tiles that are not finished.
  std::vector<periodic::SearchedPlace> places(const std::vector<std::uint64_t>& row,
                                              const engine::TileIndex& index, engine::TileReader& reader);
  // The same without a map: all points, and no numbers.
  std::vector<periodic::SearchedPlace> places() const;

  // progress: called with each point; what it throws ends the work.
  std::vector<periodic::Branch> follow(const std::vector<std::uint64_t>& row,
                                       const std::vector<periodic::SearchedPlace>& places,
                                       const periodic::BranchProgress& progress) const;

 private:
  const ParameterAxis& axis() const;

  const MapPlan& plan_;
  std::vector<periodic::Quantity> quantities_;
  std::optional<std::size_t> coexisting_;  // the index of this quantity in the record
  bool one_response_;
  engine::Bytes bytes_;
  TileEntry entry_;
};

// The quantities of the study that the points of a branch have: all but those of the search in a map.
std::vector<periodic::Quantity> branch_quantities(const Study& study);

}  // namespace frahm::studies
