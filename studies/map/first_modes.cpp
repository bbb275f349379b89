#include "studies/map/first_modes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "solvers/mechanics/modes.hpp"
#include "studies/map/grid.hpp"
#include "studies/provenance/group_columns.hpp"
#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t most_modes = 12;  // of a structure the lowest few are excited; `frahm check` lists all

std::vector<double> numbers_from_one(std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t k = 1; k <= count; ++k) numbers.push_back(static_cast<double>(k));
  return numbers;
}

std::vector<results::Column> mode_columns(const Study& study, periodic::LinearModes modes) {
  const std::size_t count = std::min(most_modes, modes.frequency.size());
  modes.frequency.resize(count);
  modes.damping.resize(count);
  GroupColumns columns;
  columns.add_count("mode", "mode", numbers_from_one(count));
  const UsualUnit unit = frequency_unit_in_file(study);
  for (double& frequency : modes.frequency) frequency /= unit.si_factor;
  columns.add("mode_frequency", unit.text, "mode", modes.frequency);
  columns.add("mode_damping", "1", "mode", modes.damping);
  for (std::size_t k = 0; k < count; ++k)
    columns.add({"mode_shape_*", {std::to_string(k + 1)}, {fmt::format("mode {}", k + 1)}}, "1", "mode_mass",
                modes.shape[k]);
  return columns.take();
}

}  // namespace

std::vector<double> parameters_at_first_point(const Study& study) {
  std::vector<double> parameters = study.parameters.nominal();
  const std::size_t dimensions = study.map() == nullptr ? 0 : study.map()->dimensions.size();
  for (std::size_t d = 0; d < dimensions; ++d) set_along(*study.map(), d, 0, parameters);
  study.parameters.complete(std::span<double>(parameters));
  return parameters;
}

mechanics::NetworkValues values_at_first_point(const Study& study) {
  std::vector<double> parameters = parameters_at_first_point(study);
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  return values;
}

void write_modes(const Study& study, results::MapWriter& writer) {
  periodic::LinearModes modes;
  try {
    modes = periodic::linear_modes(study.network, values_at_first_point(study), false,
                                   free_masses(study.kind(), study.network));
  } catch (const mechanics::MechanicsError&) {
    return;  // the point fails for the same reason, which the record gives
  }
  const std::vector<std::uint64_t> first(study.map()->dimensions.size(), 0);
  writer.write_columns("modes", mode_columns(study, std::move(modes)));
  writer.write_texts("modes", {{"point", point_text(study, first)},
                               {"masses", fmt::format("{}", fmt::join(study.network.masses, ","))}});
}

}  // namespace frahm::studies
