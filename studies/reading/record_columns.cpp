#include "studies/reading/record_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "results/data_reader.hpp"
#include "results/store_error.hpp"
#include "studies/reading/csv_table.hpp"
#include "studies/reading/spelling.hpp"
#include "studies/reading/wanted_columns.hpp"

namespace frahm::studies {
namespace {

// A file of measurements as it is read.
struct Reading {
  const TomlSection& record;
  const std::vector<RecordForm>& forms;
  RawRecord result = {};

  [[noreturn]] void fail(const std::string& message) const { throw data_error(record, message); }
  [[noreturn]] void fail(Position position, const std::string& message) const {
    throw record.source().error_at(position, fmt::format("{}: {}", record.where(), message));
  }
};

struct CsvReading : Reading {
  std::vector<CsvRow> rows = {};
  std::vector<std::string> header = {};  // cells; empty: none
};

std::string called(const CsvReading& reading, std::size_t column) {
  if (reading.header.empty()) return fmt::format("column {}", column + 1);
  return fmt::format("column {} \"{}\"", column + 1, reading.header[column]);
}

// All rows have as many cells and are separated alike: else a decimal comma has cut a number in two.
void check_even(const CsvReading& reading) {
  const CsvRow& first = reading.rows.front();
  for (const CsvRow& row : reading.rows) {
    if (row.cells.size() == first.cells.size() && row.separator == first.separator) continue;
    const auto count = [](const CsvRow& of) {
      const char* kind = of.separator == '\t' ? "tab" : of.separator == ';' ? "semicolon" : "comma";
      return fmt::format("{} cell{}{}", of.cells.size(), of.cells.size() == 1 ? "" : "s",
                         of.separator == '\0' ? "" : fmt::format(" separated by {}", kind));
    };
    reading.fail(
        fmt::format("{}:{}: {}, but {} in line {}; rows are alike, and decimals are written with a "
                    "point",
                    reading.result.file, row.line, count(row), count(first), first.line));
  }
}

void take_header(CsvReading& reading) {
  if (!is_header(reading.rows.front())) return;
  reading.header = reading.rows.front().cells;
  reading.result.header = reading.rows.front().line;
  reading.rows.erase(reading.rows.begin());
}

// The columns that a header cell names so, with its unit or without.
std::vector<std::size_t> named(const CsvReading& reading, const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < reading.header.size(); ++i) {
    if (reading.header[i] == name || column_name(reading.header[i]).name == name) found.push_back(i);
  }
  return found;
}

// Without `columns` those count whose header is the name of a role.
std::vector<WantedColumn> wanted_by_header(const CsvReading& reading) {
  if (reading.header.empty()) {
    reading.fail(fmt::format("{}: has no header; say which column is what: columns = {{ {} = 1, ... }}",
                             reading.result.file, reading.forms.front().roles.front().name));
  }
  std::vector<std::string> found;
  for (const std::string& role : role_names(reading.forms)) {
    if (!named(reading, role).empty()) found.push_back(role);
  }
  const RecordForm& form = form_of(reading.forms, found);
  std::vector<std::string> names;
  for (const std::string& cell : reading.header) names.push_back(column_name(cell).name);
  std::vector<WantedColumn> wanted;
  for (const Role& role : form.roles) {
    const bool there = std::find(found.begin(), found.end(), role.name) != found.end();
    if (role.required && !there)
      reading.fail(fmt::format("{}:{}: no column is called \"{}\"{}", reading.result.file,
                               reading.result.header, role.name, suggestion(role.name, names)));
    if (there) wanted.push_back({role.name, std::nullopt, role.name, reading.record.position()});
  }
  for (const char* role : {label_role, doubtful_role}) {
    if (!form.is_trace && !named(reading, role).empty())
      wanted.push_back({role, std::nullopt, role, reading.record.position()});
  }
  return wanted;
}

// A header that stands over the numbers in another order than the study says would give the wrong data.
void check_order(const CsvReading& reading, const WantedColumn& column,
                 const std::vector<WantedColumn>& wanted) {
  if (reading.header.empty()) return;
  const std::string name = column_name(reading.header[*column.number - 1]).name;
  for (const WantedColumn& other : wanted) {
    if (other.role == column.role || other.role != name) continue;
    reading.fail(column.position, fmt::format("columns: {}: column {} of {} is headed \"{}\"", column.role,
                                              *column.number, reading.result.file, name));
  }
}

std::size_t index_of(const CsvReading& reading, const WantedColumn& column,
                     const std::vector<WantedColumn>& wanted) {
  const std::string where = fmt::format("columns: {}", column.role);
  const std::string& file = reading.result.file;
  if (column.number) {
    const std::size_t count =
        reading.header.empty() ? reading.rows.front().cells.size() : reading.header.size();
    if (*column.number > count)
      reading.fail(column.position,
                   fmt::format("{}: there is no column {}; {} has {}", where, *column.number, file, count));
    check_order(reading, column, wanted);
    return *column.number - 1;
  }
  if (reading.header.empty())
    reading.fail(column.position,
                 fmt::format("{}: {} has no header; give the number of the column, from 1", where, file));
  const std::vector<std::size_t> found = named(reading, column.name);
  if (found.empty())
    reading.fail(column.position, fmt::format("{}: no column of {} is called \"{}\"{}", where, file,
                                              column.name, suggestion(column.name, reading.header)));
  if (found.size() > 1)
    reading.fail(fmt::format("{}:{}: columns {} and {} are both called \"{}\"", file, reading.result.header,
                             found[0] + 1, found[1] + 1, column.name));
  return found.front();
}

// Keeps the rows that nobody doubts; what the others say is not looked at.
void leave_out_doubtful(CsvReading& reading, std::size_t column) {
  std::vector<CsvRow> kept;
  for (CsvRow& row : reading.rows) {
    const std::string& cell = row.cells[column];
    if (cell != "0" && cell != "1")
      reading.fail(fmt::format("{}:{}: {}: \"{}\" is neither 0 nor 1, which marks a doubtful row",
                               reading.result.file, row.line, called(reading, column), cell));
    if (cell == "0") kept.push_back(std::move(row));
  }
  reading.result.doubtful = reading.rows.size() - kept.size();
  reading.rows = std::move(kept);
}

RawColumn numbers_of(const CsvReading& reading, const Role& role, std::size_t index) {
  RawColumn column{&role, called(reading, index), std::nullopt, {}};
  if (!reading.header.empty()) column.unit = column_name(reading.header[index]).unit;
  column.values.reserve(reading.rows.size());
  for (const CsvRow& row : reading.rows) {
    const std::string& cell = row.cells[index];
    const auto number = cell_number(cell);
    if (!number || !std::isfinite(*number))
      reading.fail(
          fmt::format("{}:{}: {}: {}", reading.result.file, row.line, column.called, cell_problem(cell)));
    column.values.push_back(*number);
  }
  return column;
}

RawRecord read_csv_columns(CsvReading reading, const std::filesystem::path& path) {
  try {
    reading.rows = read_csv(path, reading.result.file);
  } catch (const StudyError& error) {
    reading.fail(error.what());
  }
  if (reading.rows.empty()) reading.fail(fmt::format("{}: has no rows", reading.result.file));
  check_even(reading);
  take_header(reading);
  std::vector<WantedColumn> wanted = read_wanted(reading.record, reading.forms);
  const bool by_header = wanted.empty();
  if (by_header) wanted = wanted_by_header(reading);
  const RecordForm& form = form_of_wanted(reading.record, reading.forms, wanted);
  if (reading.rows.empty())
    reading.fail(fmt::format("{}: has no rows below its header", reading.result.file));

  std::vector<std::size_t> index;
  for (const WantedColumn& column : wanted) {
    index.push_back(index_of(reading, column, wanted));
    const auto same = std::find(index.begin(), index.end() - 1, index.back());
    if (same != index.end() - 1)
      reading.fail(column.position, fmt::format("columns: {}: column {} is {} already", column.role,
                                                index.back() + 1, wanted[same - index.begin()].role));
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i].role == doubtful_role) leave_out_doubtful(reading, index[i]);
  }
  for (const CsvRow& row : reading.rows) reading.result.rows.push_back(row.line);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (const Role* role = form.find(wanted[i].role)) {
      reading.result.columns.push_back(numbers_of(reading, *role, index[i]));
    } else if (wanted[i].role == label_role) {
      for (const CsvRow& row : reading.rows) reading.result.labels.push_back(row.cells[index[i]]);
    }
  }
  return std::move(reading.result);
}

// What ends all columns of an HDF5 file alike is no measurement but the padding of shorter columns.
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

void keep_rows(RawRecord& record, const std::vector<double>& doubtful) {
  for (std::size_t i = 0; i < record.columns.front().values.size(); ++i) {
    if (doubtful.empty() || doubtful[i] == 0.0) record.rows.push_back(i + 1);
  }
  record.doubtful = record.columns.front().values.size() - record.rows.size();
  for (RawColumn& column : record.columns) {
    std::vector<double> kept;
    for (const std::size_t row : record.rows) kept.push_back(column.values[row - 1]);
    column.values = std::move(kept);
  }
}

void check_datasets(const Reading& reading, const std::vector<double>& doubtful) {
  const RawRecord& record = reading.result;
  const RawColumn& first = record.columns.front();
  for (const RawColumn& column : record.columns) {
    if (column.values.size() != first.values.size())
      reading.fail(fmt::format("{}: {} has {} values, but {} has {}; columns are of one length", record.file,
                               column.called, column.values.size(), first.called, first.values.size()));
  }
  if (!doubtful.empty() && doubtful.size() != first.values.size())
    reading.fail(
        fmt::format("{}: {} has {} values, but the doubtful rows are marked by {}; columns are of "
                    "one length",
                    record.file, first.called, first.values.size(), doubtful.size()));
}

void check_finite(const Reading& reading) {
  for (const RawColumn& column : reading.result.columns) {
    for (std::size_t i = 0; i < column.values.size(); ++i) {
      if (std::isfinite(column.values[i])) continue;
      reading.fail(
          fmt::format("{}: {} is not a finite number", reading.result.place(column, i), column.values[i]));
    }
  }
}

void check_path(const Reading& reading, const WantedColumn& column) {
  if (column.role == label_role)
    reading.fail(column.position, "columns: label: labels are read from CSV files only");
  if (column.number)
    reading.fail(column.position, fmt::format("columns: {}: the path of a dataset is expected, such as "
                                              "\"transient/time\", found the number {}",
                                              column.role, *column.number));
}

RawRecord read_hdf5_columns(Reading reading, const std::filesystem::path& path) {
  reading.result.has_lines = false;
  if (!reading.record.find("columns"))
    reading.record.fail(
        "the key \"columns\" is missing: of an HDF5 file it names the datasets, such as columns = { time = "
        "\"transient/time\" }");
  const std::vector<WantedColumn> wanted = read_wanted(reading.record, reading.forms);
  const RecordForm& form = form_of_wanted(reading.record, reading.forms, wanted);
  std::vector<double> doubtful;
  try {
    const results::DataReader file(path);
    for (const WantedColumn& column : wanted) {
      check_path(reading, column);
      results::DataColumn data = file.read(column.name);
      if (const Role* role = form.find(column.role)) {
        reading.result.columns.push_back(
            {role, fmt::format("\"{}\"", column.name), std::move(data.unit), std::move(data.values)});
      } else {
        doubtful = std::move(data.values);
      }
    }
  } catch (const results::StoreError& error) {
    reading.fail(error.what());
  }
  check_datasets(reading, doubtful);
  leave_out_padding(reading.result);
  keep_rows(reading.result, doubtful);
  check_finite(reading);
  return std::move(reading.result);
}

}  // namespace

std::string RawRecord::place(const RawColumn& column, std::size_t row) const {
  return has_lines ? fmt::format("{}:{}: {}", file, rows[row], column.called)
                   : fmt::format("{}: {}: value {}", file, column.called, rows[row]);
}

StudyError data_error(const TomlSection& record, const std::string& message) {
  return record.source().error_at(record.require("file").position,
                                  fmt::format("{}: {}", record.where(), message));
}

RawRecord read_columns(const TomlSection& record, const std::filesystem::path& folder,
                       const std::vector<RecordForm>& forms) {
  RawRecord result;
  result.file = record.text("file");
  const std::filesystem::path path = folder / result.file;
  const std::string ending = path.extension().string();
  if (ending == ".h5" || ending == ".hdf5" || ending == ".nc")
    return read_hdf5_columns({record, forms, std::move(result)}, path);
  return read_csv_columns({{record, forms, std::move(result)}, {}, {}}, path);
}

}  // namespace frahm::studies
