#include "studies/map/branch_rows.hpp"

#include <algorithm>
#include <utility>

#include "solvers/mechanics/bends.hpp"
#include "studies/map/output_quantities.hpp"

namespace frahm::studies {
namespace {

bool has_values(const SweepChoice& sweep, const std::vector<Assignment>& wanted,
                const std::vector<std::uint64_t>& row) {
  return std::ranges::all_of(wanted, [&](const Assignment& each) {
    for (std::size_t d = 0; d < row.size(); ++d) {
      for (const std::size_t a : sweep.dimensions[d].axes)
        if (sweep.axes[a].parameter == each.parameter)
          return is_on_axis(each.value, sweep.axes[a].si_values[row[d]]);
    }
    return false;
  });
}

std::size_t dimension_of(const SweepChoice& sweep, std::size_t axis) {
  const auto holds = [axis](const GridDimension& each) { return each.axes.front() == axis; };
  return static_cast<std::size_t>(std::ranges::find_if(sweep.dimensions, holds) - sweep.dimensions.begin());
}

}  // namespace

periodic::ValuesAlong values_along(const Study& study, const std::vector<double>& parameters,
                                   std::size_t along) {
  const auto with = [parameters, along](double value) {
    std::vector<double> changed = parameters;
    changed[along] = value;
    return changed;
  };
  const auto at = [&study, with](double value) {
    std::vector<double> there = with(value);
    mechanics::NetworkValues values;
    evaluate(study.values, study.parameters, there, values);
    return values;
  };
  const auto derivative = [&study, with, along](double value) {
    mechanics::NetworkValues by;
    differentiate(study.values, study.parameters, with(value), along, by);
    return by;
  };
  return {at, derivative};
}

std::vector<std::vector<std::uint64_t>> branch_rows(const Study& study) {
  const SweepChoice& sweep = *study.sweep();
  const BranchChoice& choice = *sweep.branches;
  MapBox box{std::vector<std::uint64_t>(sweep.dimensions.size(), 0), {}};
  std::vector<std::size_t> across;
  for (std::size_t d = 0; d < sweep.dimensions.size(); ++d) {
    box.count.push_back(sweep.dimensions[d].size);
    if (d != dimension_of(sweep, choice.axis)) across.push_back(d);
  }
  std::vector<std::vector<std::uint64_t>> rows;
  std::vector<std::uint64_t> row = box.start;
  do {
    const auto is_this = [&](const auto& wanted) { return has_values(sweep, wanted, row); };
    if (choice.at.empty() || std::ranges::any_of(choice.at, is_this)) rows.push_back(row);
  } while (next_point(box, across, row));
  return rows;
}

std::vector<periodic::Quantity> branch_quantities(const Study& study) {
  using periodic::Measure;
  constexpr Measure of_the_search[] = {
      Measure::status,   Measure::coexisting,  Measure::period_multiple,  Measure::floquet_radius,
      Measure::residual, Measure::error_bound, Measure::newton_iterations};
  std::vector<periodic::Quantity> quantities = output_quantities(study);
  std::erase_if(quantities, [&](const periodic::Quantity& each) {
    return std::ranges::find(of_the_search, each.measure) != std::end(of_the_search);
  });
  return quantities;
}

RowBranches::RowBranches(const MapPlan& plan)
    : plan_(plan),
      quantities_(branch_quantities(plan.study)),
      one_response_(!mechanics::may_have_several_responses(plan.study.network)) {
  const auto found =
      std::ranges::find(plan.quantities, periodic::Measure::coexisting, &periodic::Quantity::measure);
  if (found != plan.quantities.end()) coexisting_ = static_cast<std::size_t>(found - plan.quantities.begin());
}

const ParameterAxis& RowBranches::axis() const {
  const SweepChoice& sweep = *plan_.study.sweep();
  return sweep.axes[sweep.branches->axis];
}

std::vector<periodic::SearchedPlace> RowBranches::places() const {
  std::vector<periodic::SearchedPlace> places;
  for (const double value : axis().si_values) {
    places.push_back({value});
    if (one_response_) places.back().stable = 1;
  }
  return places;
}

std::vector<periodic::SearchedPlace> RowBranches::places(const std::vector<std::uint64_t>& row,
                                                         const engine::TileIndex& index,
                                                         engine::TileReader& reader) {
  const std::vector<periodic::SearchedPlace> all = places();
  const std::size_t along = dimension_of(*plan_.study.sweep(), plan_.study.sweep()->branches->axis);
  std::vector<periodic::SearchedPlace> places;
  std::optional<std::uint64_t> in_hand;
  std::vector<std::uint64_t> point = row;
  for (point[along] = 0; point[along] < all.size(); ++point[along]) {
    const std::uint64_t tile = plan_.grid.tile_of(point);
    if (!index.has(tile)) continue;
    places.push_back(all[point[along]]);
    if (one_response_ || !coexisting_) continue;
    const MapBox box = plan_.grid.box(tile);
    if (in_hand != tile) decode(reader.read(tile, bytes_), box.points() * plan_.variables.size(), entry_);
    in_hand = tile;
    const double count = entry_.values[*coexisting_ * box.points() + box.offset_of(point)];
    places.back().stable = std::max(0, static_cast<int>(count));  // -1: the point failed
  }
  return places;
}

std::vector<periodic::Branch> RowBranches::follow(const std::vector<std::uint64_t>& row,
                                                  const std::vector<periodic::SearchedPlace>& places,
                                                  const periodic::BranchProgress& progress) const {
  const Study& study = plan_.study;
  std::vector<double> parameters = study.parameters.nominal();
  for (std::size_t d = 0; d < row.size(); ++d) set_along(*study.sweep(), d, row[d], parameters);
  constexpr int most_points =
      1000;  // each way: a plain branch takes some hundred, one among chaos any number
  const auto [low, high] = std::ranges::minmax(axis().si_values);
  return periodic::follow_branches(
      study.network, quantities_, values_along(study, parameters, axis().parameter),
      {.low = low, .high = high, .most_points = most_points}, study.orbits_wanted(), places, progress);
}

}  // namespace frahm::studies
