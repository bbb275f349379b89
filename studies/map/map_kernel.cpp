#include "studies/map/map_kernel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "solvers/mechanics/element_table.hpp"
#include "studies/map/comparison.hpp"
#include "studies/map/output_quantities.hpp"

namespace frahm::studies {
namespace {

// The quantities of the study's own response: those recorded, then others that are compared, and by which
// they are distinguished from nothing.
std::vector<periodic::Quantity> asked_for(const Study& study, std::vector<periodic::Quantity> quantities) {
  if (!study.sweep()->comparison) return quantities;
  const auto ask = [&](const periodic::Quantity& quantity) {
    if (std::ranges::find(quantities, quantity) == quantities.end()) quantities.push_back(quantity);
  };
  for (const periodic::Quantity& compared : study.sweep()->comparison->quantities) {
    ask(compared);
    if (const auto size = size_of_compared(compared)) ask(*size);
  }
  return quantities;
}

// Index of each contact's regime among the quantities; empty unless all are there.
std::vector<std::size_t> places_of_regimes(const mechanics::Network& network,
                                           const std::vector<periodic::Quantity>& quantities) {
  std::vector<std::size_t> places;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (!mechanics::has_own_contact(network.elements[e])) continue;
    const auto found = std::ranges::find(quantities, periodic::Quantity{periodic::Measure::regime, e});
    if (found == quantities.end()) return {};
    places.push_back(static_cast<std::size_t>(found - quantities.begin()));
  }
  return places;
}

}  // namespace

MapKernel::MapKernel(const Study& study, const Grid& grid, std::vector<periodic::Quantity> quantities,
                     KnownPoints* earlier)
    : study_(study),
      grid_(grid),
      quantities_(quantities.size()),
      tile_(output_variables(study, quantities).size(),
            KnownDigits(study, output_variables(study, quantities)), earlier),
      own_(study, study.network, study.values, asked_for(study, quantities), study.orbits_wanted()),
      parameters_(study.parameters.nominal()),
      point_(quantities.size()) {
  if (study.sweep()->borders) {
    border_search_.emplace(study, grid);
    regimes_ = places_of_regimes(study.network, quantities);
  }
  if (!study.sweep()->comparison) return;
  const std::vector<periodic::Quantity> asked = asked_for(study, std::move(quantities));
  const auto place_of = [&](const periodic::Quantity& quantity) {
    return static_cast<std::size_t>(std::ranges::find(asked, quantity) - asked.begin());
  };
  for (const periodic::Quantity& compared : study.sweep()->comparison->quantities) {
    compared_.push_back(place_of(compared));
    const auto size = size_of_compared(compared);
    sizes_.push_back(size ? std::optional(place_of(*size)) : std::nullopt);
  }
  own_compared_.resize(compared_.size());
  own_sizes_.resize(compared_.size());
  point_.resize(quantities_ + compared_variables(study).size());
  other_.emplace(study, compared_network(study), compared_values(study), compared_quantities(study),
                 compared_orbits(study));
}

void MapKernel::operator()(std::uint64_t tile, engine::Bytes& out) {
  const MapBox box = grid_.box(tile);
  tile_.open(box);
  own_.forget();
  if (other_) other_->forget();

  const auto rows = grid_.row_dimensions();
  index_ = box.start;
  do {
    compute_row(box);
  } while (next_point(box, rows, index_));
  if (border_search_) {
    tile_.entry.borders.emplace();
    border_search_->find(box, regimes_of_tile(), *tile_.entry.borders);
  }
  encode(tile_.entry, out);
}

// Those of the tile as recorded, if all of it was computed here and all are recorded.
std::vector<std::span<const double>> MapKernel::regimes_of_tile() const {
  if (regimes_.empty() || tile_.has_known()) return {};
  std::vector<std::span<const double>> regimes;
  for (const std::size_t quantity : regimes_) regimes.push_back(tile_.values_of(quantity));
  return regimes;
}

// Whether all points of a row are known. A sweep needs those before it.
bool MapKernel::is_row_known(std::uint64_t offset, std::uint64_t step, std::uint64_t count) const {
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!tile_.is_known(offset + i * step)) return false;
  }
  return true;
}

// The points of the row that begins at index_, along the last dimension in the order of computation.
void MapKernel::compute_row(const MapBox& box) {
  const std::size_t along = grid_.order.back();
  std::uint64_t offset = box.offset_of(index_), step = 1;  // of the row's first point; to the next point
  for (std::size_t d = 0; d < index_.size(); ++d) {
    if (d > along) step *= box.count[d];
    if (d != along) set_along(*study_.sweep(), d, index_[d], parameters_);
  }
  if (study_.sweep()->sweeps_frequency() && !is_row_known(offset, step, box.count[along])) {
    for (std::uint64_t i = 0; i < box.count[along]; ++i) tile_.compute_anew(offset + i * step);
  }
  own_.begin_row();
  if (other_) other_->begin_row();
  offsets_.clear();
  for (std::uint64_t i = 0; i < box.count[along]; ++i, offset += step) {
    if (tile_.is_known(offset)) continue;
    set_along(*study_.sweep(), along, box.start[along] + i, parameters_);
    own_.add_point(parameters_);
    if (other_) other_->add_point(parameters_);
    offsets_.push_back(offset);
  }
  own_.solve();
  if (other_) other_->solve();
  for (std::size_t i = 0; i < offsets_.size(); ++i) record_point(i, offsets_[i]);
}

// Point i of the row that was solved, at this offset in the tile.
void MapKernel::record_point(std::size_t i, std::uint64_t offset) {
  const std::span<const double> own = own_.quantities(i);
  std::copy_n(own.begin(), quantities_, point_.begin());
  std::string reason = own_.reason(i);
  if (other_) {
    for (std::size_t c = 0; c < compared_.size(); ++c) {
      own_compared_[c] = own[compared_[c]];
      own_sizes_[c] = sizes_[c] ? own[*sizes_[c]] : 0.0;
    }
    compare(own_compared_, own_sizes_, other_->quantities(i), std::span(point_).subspan(quantities_));
    if (reason.empty() && !other_->reason(i).empty()) reason = fmt::format("compared: {}", other_->reason(i));
  }
  tile_.put(offset, point_, std::move(reason));
}

}  // namespace frahm::studies
