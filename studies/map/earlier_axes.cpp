#include "studies/map/earlier_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "results/store_error.hpp"
#include "studies/map/value_match.hpp"
#include "studies/reading/quantities/units.hpp"

namespace frahm::studies {
namespace {

// A parameter on an axis of the earlier map, and its axis here.
struct CommonParameter {
  std::size_t axis = 0;                // index in Study::axes
  std::vector<double> earlier_values;  // SI
};

[[noreturn]] void fail(const std::string& file, const std::string& why) {
  throw StudyError(rules::wrong_option, "--from {}: {}", file, why);
}

// Converts to SI exactly as for the study's own axes, so that equal values agree to the last bit.
std::vector<double> si_values(const Parameter& parameter, const results::Coordinate& coordinate,
                              const UnitSystem& units) {
  std::vector<double> values = coordinate.values;
  if (coordinate.unit == "1") return values;  // a pure number, or SI
  const double factor = si_factor(parameter, units.parse(coordinate.unit));
  for (double& value : values) value *= factor;
  return values;
}

// What is wrong with the values of a parameter on its axis of a map; nothing if they are the study's.
std::optional<std::string> axis_damage(const Study& study, const ParameterAxis& own,
                                       const results::Axis& axis, const UnitSystem& units) {
  // Values in another unit, and powers from another library, differ in their last digits.
  constexpr double rounding = 1e-13;
  const Parameter& parameter = study.parameters.list[own.parameter];
  const auto found = std::ranges::find(axis.coordinates, parameter.name, &results::Coordinate::name);
  if (found == axis.coordinates.end()) return fmt::format("\"{}\" is not on its axis", parameter.name);
  std::vector<double> values;
  try {
    values = si_values(parameter, *found, units);
  } catch (const UnitError& error) {
    return fmt::format("axis \"{}\": {}", parameter.name, error.what());
  }
  for (std::size_t i = 0; i < own.si_values.size(); ++i) {
    if (i < values.size() && std::abs(values[i] - own.si_values[i]) <= rounding * std::abs(own.si_values[i]))
      continue;
    return fmt::format("axis \"{}\": value {} is {} where its study has {} {}", parameter.name, i + 1,
                       i < values.size() ? fmt::format("{}", found->values[i]) : "missing", own.values[i],
                       own.unit);
  }
  return std::nullopt;
}

std::vector<CommonParameter> parameters_on(const Study& study, const results::Axis& earlier,
                                           const UnitSystem& units, const std::string& file) {
  std::vector<CommonParameter> found;
  for (std::size_t a = 0; a < study.map()->axes.size(); ++a) {
    const Parameter& parameter = study.parameters.list[study.map()->axes[a].parameter];
    const auto coordinate =
        std::ranges::find(earlier.coordinates, parameter.name, &results::Coordinate::name);
    if (coordinate == earlier.coordinates.end()) continue;
    try {
      found.push_back({a, si_values(parameter, *coordinate, units)});
    } catch (const UnitError& error) {
      fail(file, fmt::format("axis \"{}\": {}", parameter.name, error.what()));
    }
  }
  if (found.empty()) fail(file, fmt::format("its axis \"{}\" is not an axis of this study", earlier.name));
  return found;
}

// The dimension of the study that holds all these parameters.
std::size_t common_dimension(const Study& study, const std::vector<CommonParameter>& parameters,
                             const std::string& earlier, const std::string& file) {
  for (std::size_t d = 0; d < study.map()->dimensions.size(); ++d) {
    const auto& axes = study.map()->dimensions[d].axes;
    const auto is_here = [&](const CommonParameter& each) {
      return std::ranges::find(axes, each.axis) != axes.end();
    };
    if (std::ranges::all_of(parameters, is_here)) return d;
  }
  fail(file, fmt::format("the parameters of its dimension \"{}\" advance together there but have dimensions "
                         "of their own here, so its points cannot be found on this grid",
                         earlier));
}

// For each index the ranks of the known values of its parameters; nothing if one has no known value.
using Place = std::vector<std::uint32_t>;

std::optional<Place> place_of(const std::vector<std::vector<std::uint32_t>>& numbers, std::size_t index) {
  Place place;
  for (const auto& of_parameter : numbers) {
    if (of_parameter[index] == ValueMatch::none) return std::nullopt;
    place.push_back(of_parameter[index]);
  }
  return place;
}

EarlierDimension match(const Study& study, const results::Axis& earlier, const UnitSystem& units,
                       const std::string& file) {
  const std::vector<CommonParameter> parameters = parameters_on(study, earlier, units, file);
  EarlierDimension dimension{
      .along = common_dimension(study, parameters, earlier.name, file), .index = {}, .places = 0};
  std::vector<std::vector<std::uint32_t>> known, wanted;
  for (const CommonParameter& each : parameters) {
    ValueMatch same = match_values(each.earlier_values, study.map()->axes[each.axis].si_values);
    known.push_back(std::move(same.known));
    wanted.push_back(std::move(same.wanted));
  }
  std::map<Place, std::uint64_t> index_of;  // the first, if points of a zip are equal
  for (std::uint64_t i = 0; i < earlier.size; ++i) index_of.emplace(*place_of(known, i), i);
  dimension.places = index_of.size();
  bool any = false;
  for (std::size_t i = 0; i < study.map()->dimensions[dimension.along].size; ++i) {
    const auto place = place_of(wanted, i);
    const auto found = place ? index_of.find(*place) : index_of.end();
    any = any || found != index_of.end();
    dimension.index.push_back(found == index_of.end() ? EarlierDimension::nowhere : found->second);
  }
  if (!any)
    fail(file, fmt::format("\"{}\" has no value in common with this study's: there is no point to reuse",
                           earlier.name));
  return dimension;
}

}  // namespace

std::vector<EarlierDimension> match_axes(const Study& study, const results::MapLayout& earlier,
                                         const std::string& file) {
  const UnitSystem units;
  std::vector<EarlierDimension> dimensions;
  for (const results::Axis& axis : earlier.axes) dimensions.push_back(match(study, axis, units, file));
  return dimensions;
}

std::uint64_t points_off_grid(const std::vector<EarlierDimension>& dimensions) {
  // Dimensions of the earlier map that advance together in this study are counted together.
  std::map<std::size_t, std::vector<const EarlierDimension*>> of_study;
  std::uint64_t all = 1, common = 1;
  for (const EarlierDimension& dimension : dimensions) {
    of_study[dimension.along].push_back(&dimension);
    all *= dimension.places;
  }
  for (const auto& [along, together] : of_study) {
    std::set<std::vector<std::uint64_t>> reached;
    for (std::size_t i = 0; i < together.front()->index.size(); ++i) {
      std::vector<std::uint64_t> place;
      for (const EarlierDimension* dimension : together) place.push_back(dimension->index[i]);
      if (std::ranges::find(place, EarlierDimension::nowhere) == place.end()) reached.insert(place);
    }
    common *= reached.size();
  }
  return all - common;
}

void refuse_other_axes(const Study& study, const results::MapLayout& map, const std::string& file,
                       const std::string& advice) {
  const auto fail = [&](const std::string& what) {
    throw results::StoreError(file, "the result is damaged: " + what, advice);
  };
  const auto& dimensions = study.map()->dimensions;
  if (map.axes.size() != dimensions.size())
    fail(fmt::format("it has {} axes where its study has {}", map.axes.size(), dimensions.size()));
  const UnitSystem units;
  for (std::size_t d = 0; d < dimensions.size(); ++d) {
    const results::Axis& axis = map.axes[d];
    if (axis.name != dimensions[d].name || axis.size != dimensions[d].size)
      fail(fmt::format("axis {} is \"{}\" of {} values where its study has \"{}\" of {}", d + 1, axis.name,
                       axis.size, dimensions[d].name, dimensions[d].size));
    for (const std::size_t a : dimensions[d].axes) {
      if (const auto problem = axis_damage(study, study.map()->axes[a], axis, units)) fail(*problem);
    }
  }
}

}  // namespace frahm::studies
