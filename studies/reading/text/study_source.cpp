#include "studies/reading/text/study_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/reading/text/plain_text.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t excerpt_before = 70;  // characters of a long line shown before the column
constexpr std::size_t excerpt_length = 100;

bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

// Byte offset of the character `index` (from 0) of a UTF-8 text.
std::size_t byte_offset(std::string_view text, std::size_t index) {
  std::size_t at = 0;
  for (; at < text.size(); ++at) {
    if (!continues_character(text[at]) && index-- == 0) break;
  }
  return at;
}

// Tabs become spaces, so that the mark stands under its column; a line stays one line.
std::string printable(std::string_view text) {
  std::string shown = plain_text(text);
  std::ranges::replace(shown, '\t', ' ');
  std::ranges::replace(shown, '\n', '?');
  return shown;
}

std::string excerpt(std::string_view line, Position position) {
  std::size_t column = position.column - 1;
  const std::size_t first = column > excerpt_before ? column - excerpt_before : 0;
  column -= first;
  line.remove_prefix(byte_offset(line, first));
  line = line.substr(0, byte_offset(line, excerpt_length));
  return fmt::format("\n{:5} | {}\n      | {:>{}}", position.line, printable(line), '^', column + 1);
}

}  // namespace

std::string_view StudySource::line(std::size_t number) const {
  std::string_view rest = text;
  for (; number > 1; --number) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) return "";
    rest.remove_prefix(end + 1);
  }
  rest = rest.substr(0, rest.find('\n'));
  if (rest.ends_with('\r')) rest.remove_suffix(1);
  return rest;
}

std::string StudySource::placed(Position position, std::string_view message) const {
  if (position.line == 0) return fmt::format("{}: {}", name, printable(message));
  const std::string_view shown = line(position.line);
  return fmt::format("{}:{}:{}: {}{}", name, position.line, position.column, printable(message),
                     shown.empty() ? "" : excerpt(shown, position));
}

Position StudySource::inside_string(Position string, std::size_t offset) const {
  std::string_view rest = line(string.line);
  rest.remove_prefix(byte_offset(rest, string.column - 1));
  const bool quoted = rest.starts_with('"') || rest.starts_with('\'');
  if (!quoted || rest.starts_with("\"\"\"") || rest.starts_with("'''")) return string;
  const std::string_view before = rest.substr(1, offset);
  if (before.find('\\') != std::string_view::npos) return string;
  return {string.line, string.column + 1 + offset};
}

}  // namespace frahm::studies
