#include <cmath>

#include "studies/map/map_groups.hpp"
#include "studies/provenance/result_variables.hpp"

namespace frahm::studies {
namespace {

// The regimes as flags of the map.
results::Variable regime(const Study& study, std::size_t element, const Named& named) {
  results::Variable variable{.name = named.name(), .long_name = named.meaning(), .type = results::Type::flag};
  const auto description = periodic::describe({periodic::Measure::regime, element}, study.network, false);
  for (const auto& [meaning, value] : description.flags) variable.flags.push_back({meaning, value});
  return variable;
}

}  // namespace

std::size_t create_borders(const MapPlan& plan, results::MapWriter& writer) {
  const Study& study = plan.study;
  std::vector<results::Variable> variables;
  for (const ParameterAxis& axis : study.map()->axes)
    variables.push_back(parameter_variable(study, axis.parameter, axis.unit));
  std::vector<std::string> elements, dimensions;
  std::size_t one_contact = 0;
  for (std::size_t e = 0; e < study.network.elements.size(); ++e) {
    if (!mechanics::has_own_contact(study.network.elements[e])) continue;
    elements.push_back(study.network.elements[e].name);
    one_contact = e;
  }
  for (const GridDimension& dimension : study.map()->dimensions) dimensions.push_back(dimension.name);
  variables.push_back(flag_variable("element", elements));
  variables.push_back(flag_variable("axis", dimensions));
  variables.push_back(regime(study, one_contact, "regime_below"));
  variables.push_back(regime(study, one_contact, "regime_above"));
  return writer.create_ragged({.group = "borders", .row = "border", .row_variables = variables});
}

std::vector<double> border_row(const Study& study, const MapBox& tile, const Border& border) {
  std::vector<double> row(study.map()->axes.size());
  std::uint64_t rest = border.offset;
  for (std::size_t d = study.map()->dimensions.size(); d-- > 0; rest /= tile.count[d]) {
    const std::size_t index = tile.start[d] + rest % tile.count[d];
    for (const std::size_t a : study.map()->dimensions[d].axes) {
      const std::vector<double>& values = study.map()->axes[a].values;
      row[a] = d == border.dimension ? std::lerp(values[index], values[index + 1], border.crossing.at)
                                     : values[index];
    }
  }
  row.push_back(static_cast<double>(border.element + 1));
  row.push_back(static_cast<double>(border.dimension + 1));
  row.push_back(static_cast<double>(border.crossing.below));
  row.push_back(static_cast<double>(border.crossing.above));
  return row;
}

}  // namespace frahm::studies
