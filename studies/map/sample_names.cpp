#include "studies/map/sample_names.hpp"

#include <set>
#include <string>

#include "studies/map/statistics_group.hpp"
#include "studies/map/tornado_group.hpp"

namespace frahm::studies {

void check_sample_names(const MapPlan& plan) {
  const MapChoice& map = *plan.study.map();
  if (!map.samples) return;
  std::set<std::string> needed{statistics_group, tornado_group};
  for (const auto& variables : {statistics_variables(plan), tornado_variables(plan)}) {
    for (const results::Variable& variable : variables) needed.insert(variable.name);
  }
  const auto check = [&](const std::string& name, Position position) {
    if (needed.contains(name))
      throw plan.study.source.error_at(
          rules::name_taken, position,
          "\"{}\" is a name in the statistics of the samples, in the same file; rename it", name);
  };
  for (const GridDimension& dimension : map.dimensions)
    if (!dimension.axes.empty()) check(dimension.name, map.axes[dimension.axes.front()].position);
  for (const ParameterAxis& axis : map.axes)
    check(plan.study.parameters.list[axis.parameter].name, axis.position);
  for (const DerivedCoordinate& coordinate : map.coordinates)
    check(coordinate.name, coordinate.value.position);
}

}  // namespace frahm::studies
