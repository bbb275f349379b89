#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "studies/map/grid.hpp"
#include "studies/map/known_digits.hpp"
#include "studies/map/tile_entry.hpp"

namespace frahm::studies {

class KnownPoints;

// The record of a tile while its points are computed: it begins with the points that an earlier result has,
// and takes the values of the others, rounded to their known digits, with the reasons of those that fail.
// Its memory is used again by the next tile.
class OpenTile {
 public:
  // variables: of the record.  earlier: must outlive the tile; may be null.
  OpenTile(std::size_t variables, KnownDigits digits, KnownPoints* earlier)
      : variables_(variables), digits_(std::move(digits)), earlier_(earlier) {}

  void open(const MapBox& box);
  // offset: of a point in the box, row-major.
  bool is_known(std::uint64_t offset) const { return known_[offset] != 0; }
  void compute_anew(std::uint64_t offset) { known_[offset] = 0; }
  bool has_known() const;

  // values: of the variables; they are rounded.  reason: why the point fails; empty: it does not.
  void put(std::uint64_t offset, std::span<double> values, std::string reason);
  std::span<const double> values_of(std::size_t variable) const {
    return std::span(entry.values).subspan(variable * points_, points_);
  }

  TileEntry entry;

 private:
  std::size_t variables_;
  KnownDigits digits_;
  KnownPoints* earlier_;
  std::uint64_t points_ = 0;
  std::vector<char> known_;  // of each point: its values are those of the earlier result
};

}  // namespace frahm::studies
