#include "studies/reading/lookup_table.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "studies/reading/study_source.hpp"

namespace frahm::studies {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> as_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

struct Row {
  std::optional<double> x, y;
};

std::optional<Row> as_row(std::string_view line) {
  const std::size_t separator = line.find_first_of(",;\t");
  if (separator == std::string_view::npos) return std::nullopt;
  return Row{as_number(trimmed(line.substr(0, separator))), as_number(trimmed(line.substr(separator + 1)))};
}

}  // namespace

LookupTable read_lookup_table(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw StudyError(fmt::format("{}: {}", path.string(), std::strerror(errno)));
  LookupTable table;
  std::string text;
  bool header_possible = true;
  for (std::size_t number = 1; std::getline(file, text); ++number) {
    const std::string_view line = trimmed(text);
    if (line.empty() || line.starts_with('#')) continue;
    const auto fail = [&](std::string_view rule) {
      throw StudyError(
          fmt::format("{}:{}: {}, found \"{}\"", path.string(), number, rule, line.substr(0, 40)));
    };
    const std::optional<Row> row = as_row(line);
    if (!row) fail("a row has two columns separated by a comma");
    const bool numeric = row->x && row->y;
    if (!numeric && !header_possible) fail("both columns must be numbers");
    header_possible = false;
    if (!numeric) continue;
    if (!table.x.empty() && *row->x <= table.x.back()) fail("the first column must increase from row to row");
    table.x.push_back(*row->x);
    table.y.push_back(*row->y);
  }
  if (file.bad()) throw StudyError(fmt::format("{}: {}", path.string(), std::strerror(errno)));
  if (table.x.size() < 2)
    throw StudyError(fmt::format("{}: a table needs at least two rows of numbers", path.string()));
  return table;
}

}  // namespace frahm::studies
