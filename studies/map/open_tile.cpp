#include "studies/map/open_tile.hpp"

#include <algorithm>
#include <utility>

#include "studies/map/known_points.hpp"

namespace frahm::studies {

void OpenTile::open(const MapBox& box) {
  points_ = box.points();
  entry.values.resize(variables_ * points_);
  entry.failed.clear();
  if (earlier_) {
    earlier_->take(box, entry.values, known_);
  } else {
    known_.assign(points_, 0);
  }
}

bool OpenTile::has_known() const {
  return std::ranges::any_of(known_, [](char known) { return known != 0; });
}

void OpenTile::put(std::uint64_t offset, std::span<double> values, std::string reason) {
  digits_.round(values);
  for (std::size_t q = 0; q < variables_; ++q) entry.values[q * points_ + offset] = values[q];
  if (!reason.empty()) entry.failed.push_back({offset, std::move(reason)});
}

}  // namespace frahm::studies
