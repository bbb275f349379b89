#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "studies/identification/identification_columns.hpp"
#include "studies/reading/quantities/unit_words.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {
namespace {

using identification::Estimate, identification::FittedRecord, identification::Identification;

constexpr std::size_t most_correlations = 12;  // columns that still fit next to one another
constexpr std::size_t most_rows = 30;

// An estimate in the study's unit of the parameter of the same name, otherwise SI.
struct Spoken {
  double factor = 1.0;  // SI value = factor x value
  std::string unit;
};
Spoken spoken_of(const Study& study, const Estimate& estimate) {
  std::string name = estimate.name;
  for (const IdentifiedParameter& parameter : study.identify()->parameters) {
    const std::string& own = study.parameters.list[parameter.parameter].name;
    if (parameter.each_record && estimate.name.starts_with(own + "_")) name = own;
  }
  const auto parameter = study.parameters.find(name);
  if (!parameter || !study.parameters.list[*parameter].is_number())
    return {1.0, study.dimensionless || is_pure_number(estimate.unit) ? "" : estimate.unit};
  return {usual_unit(study, *parameter).si_factor, spoken_value(study, *parameter, 1.0).unit};
}

std::string number(double value, double factor) {
  return std::isnan(value) ? "-" : fmt::format("{:.8g}", value / factor);
}

std::string remark_of(const Study& study, const Estimate& estimate) {
  if (std::isinf(estimate.high)) return "  the data do not determine it";
  for (const FixedEstimate& fixed : study.identify()->fixed) {
    if (study.parameters.list[fixed.parameter].name == estimate.name) return "  as identified before";
  }
  return "";
}

void print_estimates(const Study& study, const Identification& found, std::ostream& out) {
  if (found.estimates.empty()) return;
  fmt::print(out, "{:<36}{:>16}{:>16}{:>16}\n", "", "estimate", "95 % from", "to");
  for (const Estimate& estimate : found.estimates) {
    const Spoken spoken = spoken_of(study, estimate);
    fmt::print(out, "{:<36}{:>16}{:>16}{:>16}{}\n", in_brackets(estimate.name, spoken.unit),
               number(estimate.value, spoken.factor), number(estimate.low, spoken.factor),
               number(estimate.high, spoken.factor), remark_of(study, estimate));
  }
}

void print_correlations(const Identification& found, std::ostream& out) {
  const std::size_t n = found.estimates.size();
  if (n < 2 || n > most_correlations) return;
  const Eigen::MatrixXd matrix = identification::correlation(found.covariance);
  if (!matrix.array().isFinite().any()) return;
  fmt::print(out, "\n{:<36}", "correlation");
  for (std::size_t j = 0; j + 1 < n; ++j) fmt::print(out, "{:>8}", j + 1);
  for (std::size_t i = 0; i < n; ++i) {
    fmt::print(out, "\n{:>3} {:<32}", i + 1, found.estimates[i].name);
    for (std::size_t j = 0; j < i; ++j) {
      const double value = matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      fmt::print(out, "{:>8}", std::isnan(value) ? "-" : fmt::format("{:.3f}", value));
    }
  }
  fmt::print(out, "\n");
}

void print_quality(const Identification& found, std::ostream& out) {
  if (found.records.empty()) return;
  fmt::print(out, "\n{:<36}{:>16}\n", "fit quality (NRMSE; 100 is perfect)", "percent");
  for (const FittedRecord& record : found.records)
    fmt::print(out, "{:<36}{:>16}\n", record.name,
               std::isnan(record.nrmse) ? "-" : fmt::format("{:.8g}", record.nrmse));
}

void print_rows(const Study& study, const Identification& found, std::ostream& out) {
  if (found.rows.empty()) return;
  const std::vector<std::string>& labels = study.identify()->records.front().labels;
  fmt::print(out, "{:<36}", "row");
  for (const auto& column : found.rows) fmt::print(out, "{:>16}", column.name);
  const std::size_t rows = found.rows.front().values.size();
  for (std::size_t i = 0; i < std::min(rows, most_rows); ++i) {
    fmt::print(out, "\n{:<36}", i < labels.size() ? labels[i] : std::to_string(i + 1));
    for (const auto& column : found.rows) fmt::print(out, "{:>16.6g}", column.values[i]);
  }
  fmt::print(out, "\n{}", rows > most_rows ? fmt::format("and {} more\n", rows - most_rows) : "");
}

// " N s/m": the unit of a parameter after its value.
std::string behind(const Study& study, std::size_t parameter) {
  const std::string unit = spoken_value(study, parameter, 1.0).unit;
  return unit.empty() ? "" : " " + unit;
}

std::string motion_word(identification::MotionKind motion) {
  return motion == identification::MotionKind::free     ? "free"
         : motion == identification::MotionKind::forced ? "forced"
                                                        : "periodic";
}

}  // namespace

void print_identification_choice(const Study& study, std::ostream& out) {
  const IdentifyChoice& choice = *study.identify();
  fmt::print(out, "{:<22}{}\n", "method", method_name(choice.method));
  for (const RecordChoice& record : choice.records) {
    std::vector<std::string> roles;
    for (const DataColumn& column : record.columns) roles.push_back(column.role);
    const std::size_t rows = record.columns.front().values.size();
    fmt::print(out, "{:<21} {} rows of {}{}{}\n", "record " + record.name, rows, fmt::join(roles, ", "),
               choice.method == IdentifyMethod::grey_box ? ", " + motion_word(record.motion) : "",
               record.doubtful == 0 ? "" : fmt::format(", {} doubtful rows left out", record.doubtful));
  }
  for (const IdentifiedParameter& fitted : choice.parameters) {
    const std::string& name = study.parameters.list[fitted.parameter].name;
    if (!fitted.estimate.empty()) {
      fmt::print(out, "{:<22}takes {}\n", name, fitted.estimate);
      continue;
    }
    const double factor = fitted.unit.si_factor, nominal = study.parameters.nominal()[fitted.parameter];
    fmt::print(out, "{:<22}{:.6g} .. {:.6g}{}, from {:.6g}{}\n", name, fitted.lower / factor,
               fitted.upper / factor, behind(study, fitted.parameter), nominal / factor,
               fitted.each_record ? ", each record its own" : "");
  }
  for (const FixedEstimate& fixed : choice.fixed)
    fmt::print(out, "{:<22}{:.8g}{} as identified before\n", study.parameters.list[fixed.parameter].name,
               fixed.value / usual_unit(study, fixed.parameter).si_factor, behind(study, fixed.parameter));
}

void print_identification(const Study& study, const IdentificationResult& result, std::ostream& out) {
  fmt::print(out, "{}\n", method_name(study.identify()->method));
  if (result.first) {
    fmt::print(out, "\nfirst, by Liang and Feeny from the turning points\n");
    if (!result.first->failure.empty()) {
      fmt::print(out, "nothing: {}; the fit started from the values of the study\n", result.first->failure);
    }
    print_estimates(study, *result.first, out);
    fmt::print(out, "\nthen, by least squares over all samples ({} iterations)\n", result.fit.iterations);
  }
  print_estimates(study, result.fit, out);
  print_rows(study, result.fit, out);
  // Correlations of a formula's own results follow from the formula: they are not printed.
  if (study.identify()->method == IdentifyMethod::grey_box) print_correlations(result.fit, out);
  print_quality(result.fit, out);
  for (const std::string& note : result.fit.notes) fmt::print(out, "note: {}\n", note);
}

}  // namespace frahm::studies
