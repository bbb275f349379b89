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

// prefix: of the names, "" for those of the fit itself.
void add_estimates(const Study& study, const Identification& found, const std::string& prefix,
                   GroupColumns& columns) {
  for (const Estimate& estimate : found.estimates) {
    const std::string name = prefix + estimate.name, unit = unit_of(study, estimate.unit);
    columns.add_number(name, unit, estimate.long_name, estimate.value);
    columns.add_number(name + "_low", unit, "lower end of the 95 % interval of " + name, estimate.low);
    columns.add_number(name + "_high", unit, "upper end of the 95 % interval of " + name, estimate.high);
    columns.add_number(name + "_standard_error", unit, "standard error of " + name, estimate.standard_error);
    columns.add_number(name + "_degrees_of_freedom", "1", "degrees of freedom of the interval of " + name,
                       estimate.degrees_of_freedom);
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
    columns.add(name + "_covariance", "1",
                "covariance of " + name + " with each estimate, in the product of their units", "estimate",
                row_of(found.covariance, i));
    columns.add(name + "_correlation", "1", "correlation of " + name + " with each estimate", "estimate",
                row_of(correlation, i));
  }
}

// The data of a residual plot.
void add_record(const Study& study, const FittedRecord& record, GroupColumns& columns) {
  const std::string along = record.name + "_" + record.over;
  columns.add(along, unit_of(study, record.over_unit), record.over + " of the record " + record.name, along,
              record.at);
  for (const identification::FittedSeries& series : record.series) {
    const std::string name = record.name + "_" + series.name, unit = unit_of(study, series.unit);
    std::vector<double> residual;
    for (std::size_t i = 0; i < series.measured.size(); ++i)
      residual.push_back(series.measured[i] - series.fitted[i]);
    columns.add(name + "_measured", unit, series.name + " as measured", along, series.measured);
    columns.add(name + "_fitted", unit, series.name + " of the model", along, series.fitted);
    columns.add(name + "_residual", unit, "measured minus fitted " + series.name, along, std::move(residual));
    columns.add_number(name + "_nrmse", "percent", "fit quality of " + name,
                       identification::nrmse(std::span(&series, 1)));
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
  add_estimates(study, fit, "", columns);
  if (result.first) add_estimates(study, *result.first, "first_", columns);
  add_covariance(fit, columns);
  if (!fit.records.empty()) {
    std::vector<double> quality;
    for (const FittedRecord& record : fit.records) quality.push_back(record.nrmse);
    columns.add("nrmse", "percent",
                "fit quality of each record, 100 (1 - |y - yhat| / |y - mean y|); 100 is a perfect fit",
                "record", std::move(quality));
  }
  for (const identification::RowColumn& row : fit.rows)
    columns.add(row.name, unit_of(study, row.unit), row.long_name, "row", row.values);
  for (const FittedRecord& record : fit.records) add_record(study, record, columns);
  columns.add_flag("outcome", "how the identification ended", "", {"converged", "not_converged"},
                   {fit.converged ? converged_outcome : converged_outcome + 1.0});
  columns.add_number("degrees_of_freedom", "1", "degrees of freedom of the residuals",
                     fit.degrees_of_freedom);
  columns.add_count("iterations", "iterations of the fit", "", {static_cast<double>(fit.iterations)});
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
