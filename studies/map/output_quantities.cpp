#include "studies/map/output_quantities.hpp"

#include <fmt/format.h>

#include <map>

#include "studies/map/comparison.hpp"
#include "studies/reading/spelling.hpp"

namespace frahm::studies {
namespace {

std::string name_of(const StudyFile& study, const periodic::Quantity& quantity) {
  return periodic::describe(quantity, study.network, study.dimensionless).name;
}

std::vector<periodic::Quantity> listed_quantities(const StudyFile& study) {
  std::vector<periodic::Quantity> result;
  for (const OutputChoice::Name& name : study.output.names) {
    const auto quantity = periodic::find_quantity(name.text, study.network);
    if (!quantity) {
      std::vector<std::string> known;
      for (const auto& each : periodic::all_quantities(study.network)) known.push_back(name_of(study, each));
      throw study.source.error_at(name.position, fmt::format("[output]: quantities: there is no \"{}\"{}",
                                                             name.text, suggestion(name.text, known)));
    }
    result.push_back(*quantity);
  }
  return result;
}

// A name of the record that the study chose, and where.
struct Taken {
  std::string what;
  Position position;
};

std::map<std::string, Taken> names_of_coordinates(const StudyFile& study) {
  std::map<std::string, Taken> taken;
  for (const GridDimension& dimension : study.dimensions) {
    const Position position = study.axes[dimension.axes.front()].position;
    taken.emplace(dimension.name, Taken{"the dimension of an axis", position});
  }
  for (const ParameterAxis& axis : study.axes) {
    taken.emplace(study.parameters.list[axis.parameter].name,
                  Taken{"the parameter of an axis", axis.position});
  }
  for (const DerivedCoordinate& coordinate : study.coordinates) {
    taken.emplace(coordinate.name, Taken{"a coordinate", coordinate.value.position});
  }
  return taken;
}

}  // namespace

std::vector<periodic::Quantity> output_quantities(const StudyFile& study) {
  switch (study.output.quantities) {
    case OutputChoice::Quantities::all:
      return periodic::all_quantities(study.network);
    case OutputChoice::Quantities::listed:
      return listed_quantities(study);
    case OutputChoice::Quantities::standard:
      break;
  }
  return periodic::standard_quantities(study.network);
}

std::vector<periodic::QuantityDescription> output_variables(
    const StudyFile& study, const std::vector<periodic::Quantity>& quantities) {
  std::vector<periodic::QuantityDescription> result;
  for (const periodic::Quantity& quantity : quantities)
    result.push_back(periodic::describe(quantity, study.network, study.dimensionless));
  if (study.comparison) {
    const auto compared = compared_variables(study);
    result.insert(result.end(), compared.begin(), compared.end());
  }
  std::map<std::string, Taken> taken = names_of_coordinates(study);
  for (const auto& variable : result) {
    const auto [other, is_free] = taken.try_emplace(variable.name, Taken{variable.long_name, {}});
    if (is_free) continue;
    throw study.source.error_at(
        other->second.position,
        fmt::format("\"{}\" is the name of {} and of a result ({}), which stand in one file; rename it",
                    variable.name, other->second.what, variable.long_name));
  }
  return result;
}

}  // namespace frahm::studies
