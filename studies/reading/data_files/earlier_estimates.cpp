#include "studies/reading/data_files/earlier_estimates.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "results/map_reader.hpp"
#include "results/store_error.hpp"
#include "solvers/algebra/no_value.hpp"
#include "studies/reading/quantities/unit_words.hpp"
#include "studies/reading/study/identify_choice.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/readable_file.hpp"

namespace frahm::studies {
namespace {

const std::string covariance_ending = "_covariance";

using Columns = std::vector<results::Column>;

const results::Column* find_number(const Columns& columns, const std::string& name) {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const results::Column& column) {
    return column.variable.name == name && column.dimension.empty() && column.values.size() == 1;
  });
  return found == columns.end() ? nullptr : &*found;
}

// The estimates are in the order of the rows of the covariance matrix.
EarlierEstimates estimates_among(const Columns& columns, const std::string& file) {
  EarlierEstimates earlier;
  earlier.file = file;
  for (const results::Column& row : columns) {
    const std::string& name = row.variable.name;
    if (row.dimension.empty() || !name.ends_with(covariance_ending)) continue;
    const std::string of = name.substr(0, name.size() - covariance_ending.size());
    const results::Column* number = find_number(columns, of);
    if (!number) continue;
    earlier.names.push_back(of);
    earlier.units.push_back(number->variable.unit);
    earlier.values.push_back(number->values.front());
    const results::Column* freedom = find_number(columns, of + "_degrees_of_freedom");
    earlier.degrees_of_freedom.push_back(freedom ? freedom->values.front() : kInfinity);
    earlier.covariance.push_back(row.values);
  }
  return earlier;
}

}  // namespace

EarlierEstimates read_earlier(const std::filesystem::path& path, const std::string& file) {
  EarlierEstimates earlier;
  check_readable(path, file);
  try {
    const results::MapReader reader(path);
    if (!reader.has_group(identification_group))
      throw StudyError(rules::wrong_file, "{}: is not the result of an identification", file);
    const Columns columns = reader.columns(identification_group);
    const results::Column* outcome = find_number(columns, "outcome");
    if (outcome && outcome->values.front() != converged_outcome)
      throw StudyError(rules::wrong_file, "{}: its fit did not converge, so it cannot fix values", file);
    earlier = estimates_among(columns, file);
  } catch (const results::StoreError& error) {
    throw StudyError(rules::wrong_file, "{}", error.what());
  }
  for (const auto& row : earlier.covariance) {
    if (row.size() != earlier.names.size())
      throw StudyError(rules::wrong_file,
                       "{}: a row of its covariance has {} numbers, but it has {} estimates", file,
                       row.size(), earlier.names.size());
  }
  return earlier;
}

void check_unit(const StudyContext& context, const EarlierEstimates& earlier, std::size_t i,
                const Parameter& parameter) {
  const std::string& unit = earlier.units[i];
  const auto fail = [&](Rule rule, const std::string& problem) {
    throw StudyError(rule, "{}: the estimate \"{}\": {}", earlier.file, earlier.names[i], problem);
  };
  if (is_pure_number(unit)) return;
  if (context.dimensionless)
    fail(rules::unit_in_dimensionless,
         fmt::format("its unit \"{}\" has no meaning in a dimensionless study", unit));
  try {
    if (parameter.quantity) si_factor(context.units.parse(unit), *parameter.quantity);
  } catch (const UnitError& error) {
    fail(error.rule(), fmt::format("{}; the parameter is used as {}", error.what(), parameter.used_as));
  }
}

}  // namespace frahm::studies
