#include "studies/reading/text/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/tokenizer.hpp>
#include <charconv>
#include <cmath>

#include "studies/reading/text/plain_text.hpp"
#include "studies/reading/text/readable_file.hpp"
#include "studies/reading/text/study_source.hpp"
#include "studies/reading/text/trimmed.hpp"

namespace frahm::studies {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::size_t longest_shown = 40;  // characters of a cell in a message

using Cells = boost::tokenizer<boost::escaped_list_separator<char>>;

std::string text_of(const std::filesystem::path& path, const std::string& name) {
  std::string text = read_file(path, name);
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  if (text.find('\0') != std::string::npos)
    throw StudyError(rules::not_text, "{}: is not UTF-8 text: it contains zero bytes", name);
  return text;
}

char separator_of(std::string_view line) {
  bool quoted = false;
  std::string found;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (!quoted) found += c;
  }
  for (const char separator : {'\t', ';', ','}) {
    if (found.find(separator) != std::string::npos) return separator;
  }
  return '\0';
}

std::vector<std::string> split(std::string_view line, char separator) {
  // Without an escape character: a backslash in a label is a backslash.
  const std::string separators = separator == '\0' ? std::string() : std::string(1, separator);
  const boost::escaped_list_separator<char> rule(std::string(), separators, std::string("\""));
  const std::string text(line);
  std::vector<std::string> cells;
  for (const std::string& cell : Cells(text, rule)) cells.emplace_back(trimmed(cell));
  return cells;
}

bool is_decimal_comma(std::string_view cell) {
  std::string with_point(cell);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return with_point != cell && cell_number(with_point);
}

const char* separator_name(char separator) {
  switch (separator) {
    case '\t':
      return "tabs";
    case ';':
      return "semicolons";
    case ',':
      return "commas";
  }
  return "nothing";
}

}  // namespace

std::vector<CsvRow> read_csv(const std::filesystem::path& path, const std::string& name) {
  const std::string text = text_of(path, name);
  std::vector<CsvRow> rows;
  std::string_view rest = text;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
    const std::string_view content = trimmed(line);
    if (content.empty() || content.starts_with('#')) continue;
    if (std::count(content.begin(), content.end(), '"') % 2 != 0)
      throw StudyError(rules::not_text, "{}:{}: a quote is not closed on its line", name, number);
    // A tab is blank at the ends of a line, unless tabs are what separates.
    const char inside = separator_of(content), separator = inside == '\0' ? separator_of(line) : inside;
    rows.push_back({number, separator, split(separator == '\t' ? line : content, separator)});
  }
  return rows;
}

void check_even(const std::vector<CsvRow>& rows, const std::string& name) {
  const CsvRow& first = rows.front();
  for (const CsvRow& row : rows) {
    const bool alike = row.separator == first.separator;
    if (alike && row.cells.size() == first.cells.size()) continue;
    const std::string hint = row.separator == ',' ? ", and decimals are written with a point" : "";
    if (alike)
      throw StudyError(rules::beyond_schema(rules::wrong_length),
                       "{}:{}: {} cells, but {} in line {}; all rows must have the same number{}", name,
                       row.line, row.cells.size(), first.cells.size(), first.line, hint);
    throw StudyError(rules::wrong_row,
                     "{}:{}: separated by {}, but line {} by {}; all rows must have the same separator{}",
                     name, row.line, separator_name(row.separator), first.line,
                     separator_name(first.separator), hint);
  }
}

bool is_header(const CsvRow& row) {
  return std::none_of(row.cells.begin(), row.cells.end(),
                      [](const std::string& cell) { return cell_number(cell) || is_decimal_comma(cell); });
}

ColumnName column_name(const std::string& cell) {
  const std::size_t open = cell.rfind('[');
  if (open == std::string::npos || !cell.ends_with(']')) return {cell, std::nullopt};
  const std::string_view all = cell;
  return {std::string(trimmed(all.substr(0, open))),
          std::string(trimmed(all.substr(open + 1, all.size() - open - 2)))};
}

std::optional<double> cell_number(std::string_view cell) {
  if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') cell.remove_prefix(1);
  double value = 0.0;
  // cppcheck-suppress invalidLifetime ; the string that is_decimal_comma() looks at still lives
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

std::string cell_problem(const std::string& cell) {
  if (cell.empty()) return "is empty; must be a finite number";
  const std::string shown = shortened(cell, longest_shown);
  if (cell_number(cell)) return fmt::format("\"{}\" is not a finite number", shown);
  return fmt::format("\"{}\" is not a number{}", shown,
                     is_decimal_comma(cell) ? "; decimals are written with a point" : "");
}

}  // namespace frahm::studies
