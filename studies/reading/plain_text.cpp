#include "studies/reading/plain_text.hpp"

#include "results/utf8.hpp"

namespace frahm::studies {
namespace {

// U+0000 to U+001F, U+007F, and U+0080 to U+009F, which in UTF-8 is C2 80 to C2 9F.
bool is_control(std::string_view character) {
  const auto lead = static_cast<unsigned char>(character.front());
  if (character.size() == 1) return lead < 0x20U || lead == 0x7FU;
  return lead == 0xC2U && static_cast<unsigned char>(character[1]) < 0xA0U;
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

bool is_plain_line(std::string_view text) {
  return plain_text(text) == text && text.find_first_of("\n\t") == std::string_view::npos;
}

}  // namespace frahm::studies
