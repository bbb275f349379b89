#include "studies/identification/grey_box_task.hpp"

#include <array>

#include "studies/reading/study/study_units.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

using identification::Model, identification::Signal;

// A StudyValue and its derivative by one parameter.
Dual dual_of(const Study& study, const StudyValue& value, std::span<const double> parameters,
             std::size_t by) {
  std::vector<Dual> duals;
  for (const double parameter : parameters) duals.push_back({parameter, 0.0});
  duals[by].derivative = 1.0;
  study.parameters.complete(std::span<Dual>(duals));
  return value.expression.evaluate(std::span<const Dual>(duals));
}

double value_of(const StudyValue& value, std::span<const double> parameters) {
  return value.expression.evaluate(parameters);
}

void set_model(const Study& study, std::span<double> parameters, Model& model) {
  const std::size_t n = study.network.masses.size();
  evaluate(study.values, study.parameters, parameters, model.values);
  if (study.identify()->reference_frequency)
    model.values.hysteretic_omega = value_of(*study.identify()->reference_frequency, parameters);
  model.initial.displacement.assign(n, 0.0);
  model.initial.velocity.assign(n, 0.0);
  for (const InitialValues& initial : study.initial()) {
    model.initial.displacement[initial.mass] = value_of(initial.displacement, parameters);
    model.initial.velocity[initial.mass] = value_of(initial.velocity, parameters);
  }
}

void differentiate_model(const Study& study, std::span<const double> parameters, std::size_t by,
                         Model& model) {
  const std::size_t n = study.network.masses.size();
  differentiate(study.values, study.parameters, parameters, by, model.values);
  if (study.identify()->reference_frequency)
    model.values.hysteretic_omega =
        dual_of(study, *study.identify()->reference_frequency, parameters, by).derivative;
  model.initial.displacement.assign(n, 0.0);
  model.initial.velocity.assign(n, 0.0);
  for (const InitialValues& initial : study.initial()) {
    model.initial.displacement[initial.mass] =
        dual_of(study, initial.displacement, parameters, by).derivative;
    model.initial.velocity[initial.mass] = dual_of(study, initial.velocity, parameters, by).derivative;
  }
}

// SI values of all parameters in a record, before the fitted and the fixed ones are set.
std::vector<double> parameters_in_record(const Study& study, const RecordChoice& record) {
  std::vector<double> parameters = study.parameters.nominal();
  for (const Assignment& assignment : record.set) parameters[assignment.parameter] = assignment.value;
  return parameters;
}

identification::ModelAt model_at(const Study& study) {
  const IdentifyChoice& choice = *study.identify();
  std::vector<std::size_t> places;  // indices of the entries of `at` among the parameters
  for (const IdentifiedParameter& fitted : choice.parameters) places.push_back(fitted.parameter);
  for (const FixedEstimate& fixed : choice.fixed) places.push_back(fixed.parameter);
  std::vector<std::vector<double>> records;
  for (const RecordChoice& record : choice.records) records.push_back(parameters_in_record(study, record));
  return [&study, places = std::move(places), records = std::move(records)](
             std::size_t record, std::span<const double> at, Model& model, std::vector<Model>* derivatives) {
    std::vector<double> parameters = records[record];
    for (std::size_t i = 0; i < places.size(); ++i) parameters[places[i]] = at[i];
    set_model(study, parameters, model);
    if (!derivatives) return;
    derivatives->resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      differentiate_model(study, parameters, places[i], (*derivatives)[i]);
  };
}

// The name without the ending, if it has this ending.
std::optional<std::string> before(const std::string& role, const std::string& ending) {
  if (!role.ends_with(ending)) return std::nullopt;
  return role.substr(0, role.size() - ending.size());
}

void add_column(const Study& study, const DataColumn& column, identification::TimeRecord& record) {
  using mechanics::ExcitationKind;
  constexpr std::array<std::pair<const char*, Signal>, 3> signals{{{"_displacement", Signal::displacement},
                                                                   {"_velocity", Signal::velocity},
                                                                   {"_acceleration", Signal::acceleration}}};
  for (const auto& [ending, signal] : signals) {
    const auto node = before(column.role, ending);
    if (!node) continue;
    if (const auto mass = place_among(study.network.masses, *node)) {
      record.channels.push_back({column.role, *mass, signal, column.values});
    } else if (const auto support = place_among(study.network.prescribed, *node)) {
      record.excitation.push_back({ExcitationKind::motion, *support, column.values});
    }
    return;
  }
  if (const auto node = before(column.role, "_force")) {
    if (const auto mass = place_among(study.network.masses, *node))
      record.excitation.push_back({ExcitationKind::force, *mass, column.values});
  }
}

}  // namespace

identification::TimeRecord time_record(const Study& study, const RecordChoice& record) {
  identification::TimeRecord result;
  result.interpolation = record.interpolation;
  result.name = record.name;
  result.motion = record.motion;
  for (const DataColumn& column : record.columns) {
    if (column.role == "time") {
      result.time = column.values;
    } else {
      add_column(study, column, result);
    }
  }
  return result;
}

identification::GreyBoxTask grey_box_task(const Study& study) {
  const IdentifyChoice& choice = *study.identify();
  const std::vector<double> nominal = study.parameters.nominal();
  identification::GreyBoxTask task;
  task.network = study.network;
  task.model_at = model_at(study);
  for (const IdentifiedParameter& fitted : choice.parameters) {
    task.parameters.push_back({.name = study.parameters.list[fitted.parameter].name,
                               .unit = unit_in_file(study, fitted.parameter),
                               .start = nominal[fitted.parameter],
                               .lower = fitted.lower,
                               .upper = fitted.upper,
                               .each_record = fitted.each_record});
  }
  const auto fixed = static_cast<Eigen::Index>(choice.fixed.size());
  task.fixed_covariance.resize(fixed, fixed);
  for (Eigen::Index i = 0; i < fixed; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const FixedEstimate& estimate = choice.fixed[row];
    task.fixed.push_back({.name = study.parameters.list[estimate.parameter].name,
                          .unit = unit_in_file(study, estimate.parameter),
                          .value = estimate.value,
                          .degrees_of_freedom = estimate.degrees_of_freedom});
    for (Eigen::Index j = 0; j < fixed; ++j)
      task.fixed_covariance(i, j) = choice.fixed_covariance[row][static_cast<std::size_t>(j)];
  }
  for (const RecordChoice& record : choice.records) task.records.push_back(time_record(study, record));
  return task;
}

}  // namespace frahm::studies
