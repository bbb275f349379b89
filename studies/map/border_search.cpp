#include "studies/map/border_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace frahm::studies {
namespace {

using periodic::Regime;

std::vector<periodic::Quantity> regimes_of(const mechanics::Network& network) {
  std::vector<periodic::Quantity> regimes;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (mechanics::has_own_contact(network.elements[e])) regimes.push_back({periodic::Measure::regime, e});
  }
  return regimes;
}

// A border met on successive edges.
class BorderCurve {
 public:
  std::optional<CrossingForecast> forecast() const {
    if (places_ == 0) return std::nullopt;
    return CrossingForecast{places_ == 1 ? last_ : last_ + step_, std::max(least_reach, error_)};
  }

  void follow(const std::vector<RegimeCrossing>& crossings) {
    if (crossings.size() != 1) {
      places_ = 0;
      return;
    }
    const double at = crossings.front().at;
    error_ = places_ == 0 ? first_reach : std::abs(at - forecast()->at);
    step_ = at - last_;
    last_ = at;
    ++places_;
  }

 private:
  static constexpr double least_reach = 1e-4, first_reach = 0.05;  // of an edge

  int places_ = 0;      // number of crossings met in turn
  double last_ = 0.0;   // the last of these
  double step_ = 0.0;   // the last step to it
  double error_ = 0.0;  // of its forecast
};

}  // namespace

BorderSearch::BorderSearch(const Study& study, const Grid& grid)
    : study_(study),
      grid_(grid),
      elements_(regimes_of(study.network).size()),
      solver_(study, study.network, study.values, regimes_of(study.network), study.orbits_wanted()),
      parameters_(study.parameters.nominal()) {}

void BorderSearch::find(const MapBox& tile, std::span<const std::span<const double>> known,
                        std::vector<Border>& borders) {
  tile_ = wide_ = tile;
  for (std::size_t d = 0; d < tile.start.size(); ++d) {
    if (tile.start[d] + tile.count[d] < grid_.shape[d]) ++wide_.count[d];
  }
  regimes_.assign(wide_.points() * elements_, Regime::not_computed);
  if (!known.empty()) take_regimes(known);
  find_regimes(known.empty());
  solver_.forget();
  const auto rows = grid_.row_dimensions();
  Index row = tile.start;
  do {
    for (std::size_t d = 0; d < row.size(); ++d) search_row(row, d, borders);
  } while (next_point(tile, rows, row));
}

// Whether a point of wide_ lies beyond the tile's upper face along a dimension.
bool BorderSearch::is_beyond(const Index& index, std::size_t dimension) const {
  return index[dimension] == tile_.start[dimension] + tile_.count[dimension];
}

// The offset of the first element's regime at a point.
std::size_t BorderSearch::offset_of(const Index& index) const {
  return wide_.offset_of(index) * elements_;
}

void BorderSearch::take_regimes(std::span<const std::span<const double>> known) {
  std::vector<std::size_t> all(tile_.start.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Index index = tile_.start;
  std::size_t point = 0;
  do {
    for (std::size_t e = 0; e < elements_; ++e)
      regimes_[offset_of(index) + e] = static_cast<Regime>(known[e][point]);
    ++point;
  } while (next_point(tile_, all, index));
}

void BorderSearch::find_regimes(bool of_tile) {
  const auto rows = grid_.row_dimensions();
  Index row = wide_.start;
  do {
    // No edge of the tile ends beyond two faces at once.
    const auto beyond = std::ranges::count_if(rows, [&](std::size_t d) { return is_beyond(row, d); });
    if (beyond <= 1) find_regimes_of_row(row, of_tile);
  } while (next_point(wide_, rows, row));
}

// Finds the regimes of the row that begins at `index`, within the tile; then of the neighbour beyond, the
// first point of the next tile, which starts without earlier orbits, as in that tile.
void BorderSearch::find_regimes_of_row(Index index, bool of_tile) {
  const std::size_t along = grid_.order.back();
  bool is_own = true;
  for (std::size_t d = 0; d < index.size(); ++d) {
    set_along(*study_.sweep(), d, index[d], parameters_);
    is_own = is_own && !is_beyond(index, d);
  }
  const std::uint64_t points = is_own ? wide_.count[along] : tile_.count[along];
  if (of_tile || !is_own) find_regimes_of_stretch(index, 0, tile_.count[along]);
  if (points > tile_.count[along]) find_regimes_of_stretch(index, tile_.count[along], points);
}

// The points [first, last) of a row, without earlier orbits. All other dimensions are already set.
void BorderSearch::find_regimes_of_stretch(Index index, std::uint64_t first, std::uint64_t last) {
  const std::size_t along = grid_.order.back();
  solver_.forget();
  solver_.begin_row();
  for (std::uint64_t i = first; i < last; ++i) {
    set_along(*study_.sweep(), along, tile_.start[along] + i, parameters_);
    solver_.add_point(parameters_);
  }
  solver_.solve();
  for (std::uint64_t i = first; i < last; ++i) {
    index[along] = tile_.start[along] + i;
    std::ranges::transform(solver_.quantities(i - first),
                           regimes_.begin() + static_cast<std::ptrdiff_t>(offset_of(index)),
                           [](double regime) { return static_cast<Regime>(regime); });
  }
}

// The edges along a dimension that begin at the points of a row.
void BorderSearch::search_row(const Index& row, std::size_t dimension, std::vector<Border>& borders) {
  const std::size_t along = grid_.order.back();
  std::vector<BorderCurve> curves(elements_);
  Index lower = row;
  for (std::uint64_t i = 0; i < tile_.count[along]; ++i) {
    lower[along] = tile_.start[along] + i;
    if (lower[dimension] + 1 == grid_.shape[dimension]) continue;
    const std::uint64_t point = tile_.offset_of(lower);
    for (std::size_t element = 0; element < elements_; ++element) {
      const auto crossings = crossings_on_edge(lower, dimension, element, curves[element].forecast());
      curves[element].follow(crossings);
      for (const RegimeCrossing& crossing : crossings)
        borders.push_back({point, dimension, element, crossing});
    }
  }
}

std::vector<RegimeCrossing> BorderSearch::crossings_on_edge(const Index& lower, std::size_t dimension,
                                                            std::size_t element,
                                                            const std::optional<CrossingForecast>& forecast) {
  Index upper = lower;
  ++upper[dimension];
  return find_crossings(
      regimes_[offset_of(lower) + element], regimes_[offset_of(upper) + element],
      [&](double at) { return point_on_edge(lower, dimension, element, at); }, forecast);
}

// All parameters of a dimension change together along an edge, linearly in SI. Each search starts from the
// orbit of the one before, which lies near.
RegimePoint BorderSearch::point_on_edge(const Index& lower, std::size_t dimension, std::size_t element,
                                        double at) {
  for (std::size_t d = 0; d < lower.size(); ++d) set_along(*study_.sweep(), d, lower[d], parameters_);
  for (const std::size_t a : study_.map()->dimensions[dimension].axes) {
    const ParameterAxis& axis = study_.map()->axes[a];
    parameters_[axis.parameter] =
        std::lerp(axis.si_values[lower[dimension]], axis.si_values[lower[dimension] + 1], at);
  }
  const auto regime = static_cast<Regime>(solver_.solve_alone(parameters_)[element]);
  if (!has_regime(regime)) return {regime};
  return regime_point(regime, solver_.stretches(), element);
}

}  // namespace frahm::studies
