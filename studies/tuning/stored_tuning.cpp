#include "studies/tuning/stored_tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "results/map_reader.hpp"
#include "studies/provenance/stored_study.hpp"
#include "studies/tuning/optimum_columns.hpp"

namespace frahm::studies {
namespace {

std::vector<double> values_of(const std::vector<results::Column>& columns, const std::string& name) {
  const auto column = std::find_if(columns.begin(), columns.end(),
                                   [&](const results::Column& each) { return each.variable.name == name; });
  return column == columns.end() ? std::vector<double>{} : column->values;
}

}  // namespace

StoredTuning read_stored_tuning(const std::filesystem::path& file) {
  const results::MapReader result(file);
  if (!result.has_group(optimum_group))
    throw StudyError(rules::wrong_file, "{}: is not the result of a tuning", file.string());
  StoredTuning stored;
  StoredStudy of_file = read_stored_study(result, file);
  stored.study = std::move(of_file.study);
  stored.overrides = std::move(of_file.overrides);
  const Study& study = stored.study;
  const auto columns = result.columns(optimum_group);
  for (const DesignChoice& design : study.tune()->designs) {
    const std::string& name = study.parameters.list[design.parameter].name;
    std::vector<double> values = values_of(columns, name);
    const bool known = !values.empty() && std::none_of(values.begin(), values.end(),
                                                       [](double value) { return std::isnan(value); });
    if (!known) throw StudyError(rules::wrong_file, "{}: has no design: {} is missing", file.string(), name);
    for (double& value : values) value *= design.unit.si_factor;
    DesignCourse course{.values = std::move(values), .knots = values_of(columns, "knots_" + name)};
    for (double& knot : course.knots) knot *= study.tune()->band->unit.si_factor;
    stored.design.push_back(std::move(course));
  }
  if (study.tune()->band)
    stored.band = values_of(columns, study.parameters.list[study.tune()->band->parameter].name);
  return stored;
}

}  // namespace frahm::studies
