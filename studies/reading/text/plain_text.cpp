#include "studies/reading/text/plain_text.hpp"

#include "results/utf8.hpp"

namespace frahm::studies {
namespace {

// U+0000 to U+001F, U+007F, and U+0080 to U+009F, which in UTF-8 is C2 80 to C2 9F; and what turns the
// direction of the text after it: U+200E and U+200F, U+202A to U+202E, U+2066 to U+2069.
bool is_control(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  if (character.size() == 1) return byte(0) < 0x20U || byte(0) == 0x7FU;
  if (character.size() == 2) return byte(0) == 0xC2U && byte(1) < 0xA0U;
  if (character.size() != 3 || byte(0) != 0xE2U) return false;
  const bool is_mark = byte(1) == 0x80U && (byte(2) == 0x8EU || byte(2) == 0x8FU);
  const bool is_embedding = byte(1) == 0x80U && byte(2) >= 0xAAU && byte(2) <= 0xAEU;
  const bool is_isolate = byte(1) == 0x81U && byte(2) >= 0xA6U && byte(2) <= 0xA9U;
  return is_mark || is_embedding || is_isolate;
}

}  // namespace

std::string plain_text(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = text[at] == '\0' ? 0 : results::character_length(text, at);
    const std::string_view character = text.substr(at, length);
    const bool is_space = character == "\n" || character == "\t";
    if (length > 0 && (is_space || !is_control(character)))
      plain += character;
    else
      plain += '?';
    at += length > 0 ? length : 1;
  }
  return plain;
}

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
  while (most > 0 && continues(text[most])) --most;
  return std::string(text.substr(0, most)) + "...";
}

bool is_plain_line(std::string_view text) {
  return plain_text(text) == text && text.find_first_of("\n\t") == std::string_view::npos;
}

}  // namespace frahm::studies
