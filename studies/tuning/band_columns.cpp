#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "studies/tuning/tuned_design.hpp"
#include "studies/tuning/tuning_about.hpp"

namespace frahm::studies {
namespace {

// A number at each value of the band, from the optimum's parameters there.
using AtPlace = std::function<double(const std::vector<double>& parameters, double place)>;

std::vector<double> along_band(const TuningAbout& about, const AtPlace& value) {
  const DesignValues design = design_values(about.optimum);
  std::vector<double> values;
  for (const double place : about.result.assessment.band)
    values.push_back(value(parameters_of(about.study, design, 0, place), place));
  return values;
}

AtPlace of_formula(const StudyValue& value) {
  return [&value](const std::vector<double>& parameters, double) {
    return value.expression.evaluate(std::span<const double>(parameters));
  };
}

double range_flag(const ColumnChoice& column, double value) {
  if (std::isnan(value)) return 0.0;
  return value < column.lower ? 2.0 : value > column.upper ? 3.0 : 1.0;
}

void add_worst(const TuningAbout& about, const tuning::Curve& curve, GroupColumns& columns) {
  columns.add_number({"worst_" + curve.name, {}, {}}, objective_unit(about.study), curve.worst);
}

void add_curves(const TuningAbout& about, GroupColumns& columns) {
  const auto names = scenario_names(about.study);
  for (const tuning::Curve& curve : about.result.assessment.curves) {
    for (std::size_t s = 0; s < std::min(names.size(), curve.value.size()); ++s) {
      const bool is_sole = about.tune.scenarios.empty();
      columns.add({fmt::format("response_{}*", curve.name),
                   {is_sole ? "" : "_" + names[s]},
                   {about.tune.quantity_name, is_sole ? "" : ", scenario " + names[s]}},
                  quantity_unit(about.study), about.band, curve.value[s]);
    }
    add_worst(about, curve, columns);
  }
}

void add_schedules(const TuningAbout& about, GroupColumns& columns) {
  const DesignValues design = design_values(about.optimum);
  const auto rules = rules_of(about.study);
  for (std::size_t i = 0; i < about.designs.size(); ++i) {
    const auto& [choice, name, unit] = about.designs[i];
    if (!choice.is_scheduled()) continue;
    std::vector<double> schedule, rule;
    for (const double place : about.result.assessment.band) {
      schedule.push_back(value_at(design[i], place) / choice.unit.si_factor);
      if (rules[i]) rule.push_back(rules[i](place) / choice.unit.si_factor);
    }
    columns.add({"*_schedule", name}, unit, about.band, schedule);
    if (rules[i]) columns.add({"*_rule", name}, unit, about.band, rule);
  }
}

void add_column(const TuningAbout& about, const ColumnChoice& column, GroupColumns& columns) {
  std::vector<double> values = along_band(about, of_formula(column.value));
  for (double& value : values) value /= column.si_factor;
  columns.add(Named::by_study(column.name, "with the schedule: " + column.name), column.unit, about.band,
              values);
  std::vector<double> flags;
  for (const double value : values) flags.push_back(range_flag(column, value));
  columns.add_flag({"*_range", column.name}, about.band, {"within", "below", "above"}, flags);
  if (std::isfinite(column.lower))
    columns.add_number({"*_range_lower", column.name}, column.unit, column.lower);
  if (std::isfinite(column.upper))
    columns.add_number({"*_range_upper", column.name}, column.unit, column.upper);
}

}  // namespace

void add_band(const TuningAbout& about, GroupColumns& columns) {
  if (!about.tune.band || about.result.assessment.band.empty()) {  // a variance is of all frequencies
    for (const tuning::Curve& curve : about.result.assessment.curves) add_worst(about, curve, columns);
    return;
  }
  std::vector<double> places;
  for (const double place : about.result.assessment.band) places.push_back(about.spoken_band(place));
  columns.add(Named::by_study(about.band, "band of the tuning"), about.band_unit, about.band, places);
  columns.add("excitation_frequency", about.study.dimensionless ? "1" : "rad s-1", about.band,
              along_band(about, of_formula(about.study.values.omega)));
  if (about.tune.weight)
    columns.add("weight", "1", about.band, along_band(about, of_formula(*about.tune.weight)));
  add_curves(about, columns);
  add_schedules(about, columns);
  for (const ColumnChoice& column : about.tune.columns) add_column(about, column, columns);
}

}  // namespace frahm::studies
