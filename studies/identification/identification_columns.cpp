#include "studies/identification/identification_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "studies/provenance/group_columns.hpp"

namespace frahm::studies {
namespace {

using identification::Estimate, identification::FittedRecord, identification::Identification;

std::string unit_of(const Study& study, const std::string& unit) {
  return study.dimensionless ? "1" : unit;
}

// is_first_stage: of the stage from which a grey box started, otherwise of the fit itself.
void add_estimates(const Study& study, const Identification& found, bool is_first_stage,
                   GroupColumns& columns) {
  for (const Estimate& estimate : found.estimates) {
    const std::string unit = unit_of(study, estimate.unit);
    const Named named = is_first_stage ? Named("first_*", {estimate.name}, {estimate.long_name})
                                       : Named::by_study(estimate.name, estimate.long_name);
    const std::string& name = named.name();
    columns.add_number(named, unit, estimate.value);
    columns.add_number({"*_low", name}, unit, estimate.low);
    columns.add_number({"*_high", name}, unit, estimate.high);
    columns.add_number({"*_standard_error", name}, unit, estimate.standard_error);
    columns.add_number({"*_degrees_of_freedom", name}, "1", estimate.degrees_of_freedom);
  }
}

std::vector<double> row_of(const Eigen::MatrixXd& matrix, std::size_t row) {
  const Eigen::VectorXd values = matrix.row(static_cast<Eigen::Index>(row));
  return {values.begin(), values.end()};
}

void add_covariance(const Identification& found, GroupColumns& columns) {
  const Eigen::MatrixXd correlation = identification::correlation(found.covariance);
  for (std::size_t i = 0; i < found.estimates.size(); ++i) {
    const std::string& name = found.estimates[i].name;
    columns.add({"*_covariance", name}, "1", "estimate", row_of(found.covariance, i));
    columns.add({"*_correlation", name}, "1", "estimate", row_of(correlation, i));
  }
}

// The data of a residual plot.
void add_record(const Study& study, const FittedRecord& record, GroupColumns& columns) {
  const std::string along = record.name + "_" + record.over;
  columns.add(Named::by_study(along, record.over + " of the record " + record.name),
              unit_of(study, record.over_unit), along, record.at);
  for (const identification::FittedSeries& series : record.series) {
    const std::string name = record.name + "_" + series.name, unit = unit_of(study, series.unit);
    std::vector<double> residual;
    for (std::size_t i = 0; i < series.measured.size(); ++i)
      residual.push_back(series.measured[i] - series.fitted[i]);
    columns.add({"*_measured", {name}, {series.name}}, unit, along, series.measured);
    columns.add({"*_fitted", {name}, {series.name}}, unit, along, series.fitted);
    columns.add({"*_residual", {name}, {series.name}}, unit, along, std::move(residual));
    columns.add_number({"*_nrmse", name}, "percent", identification::nrmse(std::span(&series, 1)));
  }
}

// A parameter or a record may have the name of something else in the file.
void refuse_same_names(const Study& study, const std::vector<results::Column>& columns) {
  std::vector<std::string> names{"estimate", "record", "row"};  // dimensions, which are indices
  for (const results::Column& column : columns) names.push_back(column.variable.name);
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice == names.end()) return;
  throw StudyError(rules::name_taken,
                   "{}: the result would have two things called \"{}\", one of them a parameter, record or "
                   "mass of the study; rename that",
                   study.source.name, *twice);
}

}  // namespace

std::vector<results::Column> identification_columns(const Study& study, const IdentificationResult& result) {
  GroupColumns columns;
  const Identification& fit = result.fit;
  add_estimates(study, fit, false, columns);
  if (result.first) add_estimates(study, *result.first, true, columns);
  add_covariance(fit, columns);
  if (!fit.records.empty()) {
    std::vector<double> quality;
    for (const FittedRecord& record : fit.records) quality.push_back(record.nrmse);
    columns.add("nrmse", "percent", "record", std::move(quality));
  }
  for (const identification::RowColumn& row : fit.rows)
    columns.add(Named::by_study(row.name, row.long_name), unit_of(study, row.unit), "row", row.values);
  for (const FittedRecord& record : fit.records) add_record(study, record, columns);
  columns.add_flag("outcome", "", {"converged", "not_converged"},
                   {fit.converged ? converged_outcome : converged_outcome + 1.0});
  columns.add_number("degrees_of_freedom", "1", fit.degrees_of_freedom);
  columns.add_count("iterations", "", {static_cast<double>(fit.iterations)});
  std::vector<results::Column> all = columns.take();
  refuse_same_names(study, all);
  return all;
}

std::vector<results::Text> identification_texts(const Study& study, const IdentificationResult& result) {
  std::vector<std::string> estimates, records;
  for (const Estimate& estimate : result.fit.estimates) estimates.push_back(estimate.name);
  for (const FittedRecord& record : result.fit.records) records.push_back(record.name);
  std::vector<results::Text> texts{{"method", method_name(study.identify()->method)},
                                   {"estimates", fmt::format("{}", fmt::join(estimates, " "))},
                                   {"records", fmt::format("{}", fmt::join(records, " "))},
                                   {"notes", fmt::format("{}", fmt::join(result.fit.notes, "\n"))}};
  const std::vector<std::string>& labels = study.identify()->records.front().labels;
  if (!labels.empty()) texts.emplace_back("row_labels", fmt::format("{}", fmt::join(labels, "\n")));
  return texts;
}

}  // namespace frahm::studies
