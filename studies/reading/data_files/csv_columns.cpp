#include "studies/reading/data_files/csv_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "studies/reading/data_files/record_columns.hpp"
#include "studies/reading/data_files/wanted_columns.hpp"
#include "studies/reading/text/csv_table.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

constexpr std::array motion_endings{"_displacement", "_velocity", "_acceleration", "_force"};

struct CsvReading : ColumnReading {
  std::vector<CsvRow> rows = {};
  std::vector<std::string> header = {};  // cells; empty: none
};

std::string called(const CsvReading& reading, std::size_t column) {
  if (reading.header.empty()) return fmt::format("column {}", column + 1);
  return fmt::format("column {} \"{}\"", column + 1, reading.header[column]);
}

void take_header(CsvReading& reading) {
  if (!is_header(reading.rows.front())) return;
  reading.header = reading.rows.front().cells;
  reading.result.header = reading.rows.front().line;
  reading.rows.erase(reading.rows.begin());
}

// The names in its cells, without units.
std::vector<std::string> header_names(const CsvReading& reading) {
  std::vector<std::string> names;
  for (const std::string& cell : reading.header) names.push_back(column_name(cell).name);
  return names;
}

// The columns with this name in the header, with or without a unit.
std::vector<std::size_t> named(const CsvReading& reading, const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < reading.header.size(); ++i) {
    if (reading.header[i] == name || column_name(reading.header[i]).name == name) found.push_back(i);
  }
  return found;
}

// A column that looks like one of a motion, but of no node that the study has, would have no effect, without
// a message.
void refuse_misspelt(const CsvReading& reading, const RecordForm& form) {
  if (!form.is_trace) return;
  std::vector<std::string> known;
  for (const Role& role : form.roles) known.push_back(role.name);
  for (const std::string& name : header_names(reading)) {
    const bool of_node = std::any_of(motion_endings.begin(), motion_endings.end(),
                                     [&](const char* ending) { return name.ends_with(ending); });
    if (!of_node || form.find(name)) continue;
    const std::string hint = suggestion(name, known);
    reading.fail_at_file(rules::unknown_name,
                         "{}:{}: \"{}\" does not belong to a node of the study{}{} To leave it out, name the "
                         "others in columns = {{ ... }}",
                         reading.result.file, reading.result.header, name, hint,
                         hint.ends_with('?') ? "" : ".");
  }
}

// Without `columns`, the columns are those whose header is the name of a role.
std::vector<WantedColumn> wanted_by_header(const CsvReading& reading) {
  if (reading.header.empty()) {
    reading.fail_at_file(rules::no_header,
                         "{}: has no header; assign the columns by number: columns = {{ {} = 1, ... }}",
                         reading.result.file, reading.forms.front().roles.front().name);
  }
  std::vector<std::string> found;
  for (const std::string& role : role_names(reading.forms)) {
    if (!named(reading, role).empty()) found.push_back(role);
  }
  const RecordForm& form = form_of(reading.forms, found);
  std::vector<WantedColumn> wanted;
  for (const Role& role : form.roles) {
    const bool there = std::find(found.begin(), found.end(), role.name) != found.end();
    if (role.required && !there)
      reading.fail_at_file(rules::unknown_column, "{}:{}: the header has no column \"{}\"{}",
                           reading.result.file, reading.result.header, role.name,
                           suggestion(role.name, header_names(reading)));
    if (there) wanted.push_back({role.name, std::nullopt, role.name, reading.record.position()});
  }
  if (!form.is_trace && !named(reading, label_role).empty())
    wanted.push_back({label_role, std::nullopt, label_role, reading.record.position()});
  refuse_misspelt(reading, form);
  return wanted;
}

// Rows marked in the file are left out even if the study does not name that column.
void want_doubtful(const CsvReading& reading, std::vector<WantedColumn>& wanted) {
  const bool there = std::any_of(wanted.begin(), wanted.end(),
                                 [](const WantedColumn& each) { return each.role == doubtful_role; });
  if (!there && !named(reading, doubtful_role).empty())
    wanted.push_back({doubtful_role, std::nullopt, doubtful_role, reading.record.position()});
}

// A header in another order than the study's columns would give the wrong data.
void check_order(const CsvReading& reading, const WantedColumn& column,
                 const std::vector<WantedColumn>& wanted) {
  if (reading.header.empty()) return;
  const std::string name = column_name(reading.header[*column.number - 1]).name;
  for (const WantedColumn& other : wanted) {
    if (other.role == column.role || other.role != name) continue;
    reading.fail(rules::unknown_column, column.position,
                 "{}: column {} of {} has the header \"{}\"; number and header disagree", column.where(),
                 *column.number, reading.result.file, name);
  }
}

std::size_t index_of(const CsvReading& reading, const WantedColumn& column,
                     const std::vector<WantedColumn>& wanted) {
  const std::string where = column.where();
  const std::string& file = reading.result.file;
  if (column.number) {
    const std::size_t count =
        reading.header.empty() ? reading.rows.front().cells.size() : reading.header.size();
    if (*column.number > count)
      reading.fail(rules::unknown_column, column.position, "{}: there is no column {}; {} has {}", where,
                   *column.number, file, count);
    check_order(reading, column, wanted);
    return *column.number - 1;
  }
  if (reading.header.empty())
    reading.fail(rules::no_header, column.position,
                 "{}: {} has no header; give the number of the column, from 1", where, file);
  const std::vector<std::size_t> found = named(reading, column.name);
  if (found.empty())
    reading.fail(rules::unknown_column, column.position, "{}: no column of {} is called \"{}\"{}", where,
                 file, column.name, suggestion(column.name, header_names(reading)));
  if (found.size() > 1)
    reading.fail_at_file(rules::given_twice, "{}:{}: columns {} and {} are both called \"{}\"", file,
                         reading.result.header, found[0] + 1, found[1] + 1, column.name);
  return found.front();
}

// Drops the rows marked as doubtful; their other cells are not read.
void leave_out_doubtful(CsvReading& reading, std::size_t column) {
  std::vector<CsvRow> kept;
  for (CsvRow& row : reading.rows) {
    const std::string& cell = row.cells[column];
    if (cell != "0" && cell != "1")
      reading.fail_at_file(rules::wrong_row,
                           "{}:{}: {}: \"{}\" is neither 0 nor 1, which marks a doubtful row",
                           reading.result.file, row.line, called(reading, column), cell);
    reading.result.first_is_doubtful |= cell == "1" && &row == &reading.rows.front();
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
      reading.fail_at_file(rules::wrong_row, "{}:{}: {}: {}", reading.result.file, row.line, column.called,
                           cell_problem(cell));
    column.values.push_back(*number);
  }
  return column;
}

RawRecord read_columns_of(CsvReading reading, const std::filesystem::path& path) {
  try {
    reading.rows = read_csv(path, reading.result.file);
    if (!reading.rows.empty()) check_even(reading.rows, reading.result.file);
  } catch (const StudyError& error) {
    reading.fail_at_file(error.rule(), "{}", error.what());
  }
  if (reading.rows.empty()) reading.fail_at_file(rules::too_few, "{}: has no rows", reading.result.file);
  take_header(reading);
  std::vector<WantedColumn> wanted =
      reading.wanted.empty() ? read_wanted(reading.record, reading.forms) : reading.wanted;
  const bool by_header = wanted.empty();
  if (by_header) wanted = wanted_by_header(reading);
  want_doubtful(reading, wanted);
  const RecordForm& form = form_of_wanted(reading.record, reading.forms, wanted);
  if (reading.rows.empty())
    reading.fail_at_file(rules::too_few, "{}:{}: has no rows below its header", reading.result.file,
                         reading.result.header);

  std::vector<std::size_t> index;
  for (const WantedColumn& column : wanted) {
    index.push_back(index_of(reading, column, wanted));
    const auto same = std::find(index.begin(), index.end() - 1, index.back());
    if (same != index.end() - 1)
      reading.fail(rules::given_twice, column.position, "{}: column {} is {} already", column.where(),
                   index.back() + 1, wanted[same - index.begin()].role);
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

}  // namespace

RawRecord read_csv_columns(const ColumnReading& reading, const std::filesystem::path& path) {
  return read_columns_of({reading, {}, {}}, path);
}

}  // namespace frahm::studies
