#include "studies/reading/quantities/lookup_table.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>

#include "studies/reading/text/csv_table.hpp"
#include "studies/reading/text/plain_text.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t longest_row = 40;  // characters of a row in a message

struct Point {
  double x = 0.0, y = 0.0;
};

std::optional<Point> as_point(const CsvRow& row) {
  if (row.cells.size() != 2) return std::nullopt;
  const auto x = cell_number(row.cells[0]), y = cell_number(row.cells[1]);
  if (!x || !y || !std::isfinite(*x) || !std::isfinite(*y)) return std::nullopt;
  return Point{*x, *y};
}

std::string shown(const CsvRow& row) {
  std::string text = row.cells.front();
  for (std::size_t i = 1; i < row.cells.size(); ++i) text += row.separator + row.cells[i];
  return shortened(text, longest_row);
}

}  // namespace

ReadTable read_lookup_table(const std::filesystem::path& path) {
  ReadTable read;
  LookupTable& table = read.table;
  bool header_possible = true;
  for (const CsvRow& row : read_csv(path, path.string())) {
    const auto fail = [&](std::string_view problem) {
      throw StudyError(rules::wrong_row, "{}:{}: {}, found \"{}\"", path.string(), row.line, problem,
                       shown(row));
    };
    if (row.cells.size() < 2) fail("a row has two columns separated by a comma");
    const std::optional<Point> point = as_point(row);
    if (!point && !header_possible) fail("both columns must be numbers");
    header_possible = false;
    if (!point) {
      read.x_unit = column_name(row.cells[0]).unit;
      read.y_unit = column_name(row.cells[1]).unit;
      continue;
    }
    if (!table.x.empty() && point->x <= table.x.back())
      fail("the first column must increase from row to row");
    table.x.push_back(point->x);
    table.y.push_back(point->y);
  }
  if (table.x.size() < 2)
    throw StudyError(rules::too_few, "{}: a table needs at least two rows of numbers", path.string());
  return read;
}

}  // namespace frahm::studies
