#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace frahm::studies {

// A line of a CSV file.
struct CsvRow {
  std::size_t line = 0;            // in the file, from 1
  char separator = '\0';           // tab before semicolon before comma; '\0': the line is one cell
  std::vector<std::string> cells;  // without the blanks around them; quotes protect separators
};

// The rows of a CSV file in UTF-8, with or without its mark and with either line ending. Blank lines and
// lines that start with # do not count.
// name: of the file, for messages.
// Throws StudyError for a file that cannot be read, is not text or has an open quote.
std::vector<CsvRow> read_csv(const std::filesystem::path& path, const std::string& name);

// Refuses rows that have not as many cells or are not separated alike: otherwise a decimal comma may have cut
// a number in two.  rows: not empty.  Throws StudyError without a place in the study.
void check_even(const std::vector<CsvRow>& rows, const std::string& name);

// Whether a row holds the names of the columns: no cell is a number, with a decimal point or a comma.
bool is_header(const CsvRow& row);

// The name and the unit in a header cell: "x [mm]" -> "x", in "mm".
struct ColumnName {
  std::string name;
  std::optional<std::string> unit;
};
ColumnName column_name(const std::string& cell);

// The number in a cell, finite or not; nothing if the cell is not a number.
std::optional<double> cell_number(std::string_view cell);

// The error in a cell that is not a finite number, for messages: `"1,5" is not a number; decimals are written
// with a point`.
std::string cell_problem(const std::string& cell);

}  // namespace frahm::studies
