#include "studies/reading/data_files/hdf5_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "results/data_reader.hpp"
#include "studies/reading/data_files/record_columns.hpp"
#include "studies/reading/data_files/wanted_columns.hpp"
#include "studies/reading/text/readable_file.hpp"

namespace frahm::studies {
namespace {

// NaN at the common end of all columns of an HDF5 file is the padding of shorter columns, not a measurement.
void leave_out_padding(RawRecord& record) {
  const auto padded = [&] {
    return !record.columns.front().values.empty() &&
           std::all_of(record.columns.begin(), record.columns.end(),
                       [](const RawColumn& column) { return std::isnan(column.values.back()); });
  };
  while (padded()) {
    for (RawColumn& column : record.columns) column.values.pop_back();
  }
}

void keep_rows(const ColumnReading& reading, RawRecord& record, const std::vector<double>& doubtful) {
  for (std::size_t i = 0; i < record.columns.front().values.size(); ++i) {
    if (!doubtful.empty() && doubtful[i] != 0.0 && doubtful[i] != 1.0)
      reading.fail_at_file(rules::wrong_row,
                           "{}: value {} of the marks of doubtful rows is {}; must be 0 or 1", record.file,
                           i + 1, doubtful[i]);
    if (doubtful.empty() || doubtful[i] == 0.0) record.rows.push_back(i + 1);
  }
  record.first_is_doubtful = record.rows.empty() || record.rows.front() != 1;
  record.doubtful = record.columns.front().values.size() - record.rows.size();
  for (RawColumn& column : record.columns) {
    std::vector<double> kept;
    for (const std::size_t row : record.rows) kept.push_back(column.values[row - 1]);
    column.values = std::move(kept);
  }
}

void check_datasets(const ColumnReading& reading, const std::vector<double>& doubtful) {
  const RawRecord& record = reading.result;
  const RawColumn& first = record.columns.front();
  for (const RawColumn& column : record.columns) {
    if (column.values.size() != first.values.size())
      reading.fail_at_file(rules::beyond_schema(rules::wrong_length),
                           "{}: {} has {} values, but {} has {}; columns must have the same length",
                           record.file, column.called, column.values.size(), first.called,
                           first.values.size());
  }
  if (!doubtful.empty() && doubtful.size() != first.values.size())
    reading.fail_at_file(
        rules::beyond_schema(rules::wrong_length),
        "{}: {} has {} values, but the marks of doubtful rows have {}; columns must have the same length",
        record.file, first.called, first.values.size(), doubtful.size());
}

void check_finite(const ColumnReading& reading) {
  for (const RawColumn& column : reading.result.columns) {
    for (std::size_t i = 0; i < column.values.size(); ++i) {
      if (std::isfinite(column.values[i])) continue;
      reading.fail_at_file(rules::wrong_row, "{}: {} is not a finite number", reading.result.where(column, i),
                           column.values[i]);
    }
  }
}

void check_path(const ColumnReading& reading, const WantedColumn& column) {
  if (column.role == label_role)
    reading.fail(rules::unknown_column, column.position,
                 "columns: label: labels are read from CSV files only");
  if (column.number)
    reading.fail(rules::beyond_schema(rules::wrong_type), column.position,
                 "{}: expected the path of a dataset, such as \"transient/time\", found the number {}",
                 column.where(), *column.number);
}

}  // namespace

RawRecord read_hdf5_columns(ColumnReading reading, const std::filesystem::path& path) {
  reading.result.has_lines = false;
  if (reading.wanted.empty() && !reading.record.find("columns"))
    reading.record.fail_here(rules::beyond_schema(rules::missing_key),
                             "the key \"columns\" is missing: for an HDF5 file it names the datasets, such "
                             "as columns = {{ time = \"transient/time\" }}");
  const std::vector<WantedColumn> wanted =
      reading.wanted.empty() ? read_wanted(reading.record, reading.forms) : reading.wanted;
  const RecordForm& form = form_of_wanted(reading.record, reading.forms, wanted);
  for (const WantedColumn& column : wanted) check_path(reading, column);
  std::vector<double> doubtful;
  try {
    check_readable(path, reading.result.file);
    const results::DataReader file(path);
    for (const WantedColumn& column : wanted) {
      results::DataColumn data = file.read(column.name);
      if (const Role* role = form.find(column.role)) {
        reading.result.columns.push_back(
            {role, fmt::format("\"{}\"", column.name), std::move(data.unit), std::move(data.values)});
      } else {
        doubtful = std::move(data.values);
      }
    }
  } catch (const std::runtime_error& error) {  // StudyError or StoreError
    reading.fail_at_file(rules::wrong_file, "{}", error.what());
  }
  check_datasets(reading, doubtful);
  leave_out_padding(reading.result);
  keep_rows(reading, reading.result, doubtful);
  check_finite(reading);
  return std::move(reading.result);
}

}  // namespace frahm::studies
