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
// name: stands for the file in messages.
// Throws StudyError: a file that cannot be read, a quote that is not closed, what is no text.
std::vector<CsvRow> read_csv(const std::filesystem::path& path, const std::string& name);

// Whether a row names its columns: no cell is a number, with a decimal point or a comma.
bool is_header(const CsvRow& row);

// What a cell of a header names: "x [mm]" -> "x", in "mm".
struct ColumnName {
  std::string name;
  std::optional<std::string> unit;
};
ColumnName column_name(const std::string& cell);

// The number that a cell is, finite or not; nothing if it is none.
std::optional<double> cell_number(std::string_view cell);

// What is wrong with a cell that is no finite number, for messages: `"1,5" is not a number; decimals are
// written with a point`.
std::string cell_problem(const std::string& cell);

}  // namespace frahm::studies
