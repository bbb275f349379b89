#include "studies/reading/map/sample_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/reading/map/axis_reading.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/csv_table.hpp"

namespace frahm::studies {
namespace {

// A column while it is read: "samples.csv:1: column 2 \"k [N/m]\"" in messages.
std::string place(const std::string& file, const CsvRow& header, std::size_t column) {
  return fmt::format("{}:{}: column {} \"{}\"", file, header.line, column + 1, header.cells[column]);
}

SampleColumn column_of(const StudyContext& context, Study& study, const ColumnName& heading,
                       const std::string& where) {
  if (const auto refusal = why_no_axis(study, heading.name))
    throw StudyError(refusal->rule, "{}: {}", where, refusal->text);
  SampleColumn column;
  column.axis.parameter = *study.parameters.find(heading.name);
  if (context.dimensionless) {
    if (heading.unit && *heading.unit != "1")
      throw StudyError(rules::unit_in_dimensionless, "{}: a dimensionless study has no units", where);
    column.axis.unit = std::string(1, '1');  // assigning "1" raises a false warning of g++ 12 (restrict)
    return column;
  }
  try {
    if (heading.unit) column.unit = context.units.parse(*heading.unit);
    set_axis_unit(column.unit, study.parameters.list[column.axis.parameter], column.axis);
  } catch (const UnitError& error) {
    throw StudyError(error.rule(), "{}: {}", where, error.what());
  }
  return column;
}

double number_in(const CsvRow& row, std::size_t column, const std::string& file, const CsvRow& header) {
  const auto number = cell_number(row.cells[column]);
  if (number && std::isfinite(*number)) return *number;
  throw StudyError(rules::wrong_row, "{}:{}: column {} \"{}\": {}", file, row.line, column + 1,
                   header.cells[column], cell_problem(row.cells[column]));
}

}  // namespace

std::vector<SampleColumn> read_sample_table(const StudyContext& context, Study& study,
                                            const std::filesystem::path& path, const std::string& name) {
  const std::vector<CsvRow> rows = read_csv(path, name);
  if (rows.empty()) throw StudyError(rules::too_few, "{}: has no rows", name);
  check_even(rows, name);
  const CsvRow& header = rows.front();
  if (!is_header(header))
    throw StudyError(
        rules::no_header,
        "{}:{}: the first row must name the parameter of each column, as in \"k [N/m],c [N s/m]\"", name,
        header.line);
  if (rows.size() < 3)
    throw StudyError(rules::too_few, "{}: has {} rows below its header; at least two samples are needed",
                     name, rows.size() - 1);
  std::vector<SampleColumn> columns;
  for (std::size_t c = 0; c < header.cells.size(); ++c) {
    const ColumnName heading = column_name(header.cells[c]);
    const std::string where = place(name, header, c);
    columns.push_back(column_of(context, study, heading, where));
    const auto same = [&](const SampleColumn& other) {
      return other.axis.parameter == columns.back().axis.parameter;
    };
    if (std::count_if(columns.begin(), columns.end(), same) > 1)
      throw StudyError(rules::given_twice, "{}: \"{}\" already has a column", where, heading.name);
    for (std::size_t r = 1; r < rows.size(); ++r)
      columns.back().axis.values.push_back(number_in(rows[r], c, name, header));
  }
  return columns;
}

}  // namespace frahm::studies
