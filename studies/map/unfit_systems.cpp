#include "studies/map/unfit_systems.hpp"

#include <algorithm>
#include <chrono>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "studies/map/grid.hpp"

namespace frahm::studies {
namespace {

using Clock = std::chrono::steady_clock;

UnfitSystems try_systems(const Study& study, bool until_fit) {
  constexpr std::chrono::milliseconds most_time(500);
  UnfitSystems found;
  if (!study.values.read_by_factors().empty()) return found;  // whose network is another at each point
  const Clock::time_point end = Clock::now() + most_time;
  const mechanics::Assembly assembly(study.network, free_masses(study.kind(), study.network));
  // All of which a system may be refused for.
  const std::vector<std::size_t> moving =
      dimensions_moving(study, study.values.read_by_system(study.network));
  const MapChoice& map = *study.map();
  MapBox box;
  for (const GridDimension& dimension : map.dimensions) {
    box.start.push_back(0);
    box.count.push_back(dimension.size);
  }
  std::vector<std::uint64_t> index = box.start;
  std::vector<double> parameters = study.parameters.nominal();
  mechanics::NetworkValues values;
  mechanics::LinearSystem system;
  do {
    if (Clock::now() > end) {
      found.tried_all = false;
      break;
    }
    for (std::size_t d = 0; d < index.size(); ++d) set_along(map, d, index[d], parameters);
    evaluate(study.values, study.parameters, parameters, values);
    ++found.tried;
    try {
      assembly.set_values(values, system);
      if (until_fit) break;
    } catch (const mechanics::MechanicsError& error) {
      if (found.unfit++ > 0) continue;
      found.first_at = point_text(study, index);
      found.reason = error.what();
    }
  } while (next_point(box, moving, index));
  return found;
}

}  // namespace

UnfitSystems unfit_systems(const Study& study) {
  return try_systems(study, false);
}

void refuse_unfit_map(const Study& study) {
  const UnfitSystems found = try_systems(study, true);
  if (found.are_all())
    throw StudyError(rules::not_computed, "{}: no point of the map can be computed, the first, {}: {}",
                     study.source.name, found.first_at, found.reason);
}

}  // namespace frahm::studies
