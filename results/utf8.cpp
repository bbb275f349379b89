#include "results/utf8.hpp"

#include <fmt/core.h>

#include <cstdint>
#include <stdexcept>

namespace frahm::results {
namespace {

// Bytes of the sequence that a leading byte opens, 0 if it opens none.
std::size_t sequence_length(unsigned char lead) {
  if (lead < 0x80) return lead == 0 ? 0 : 1;
  if (lead >= 0xC2 && lead < 0xE0) return 2;
  if (lead >= 0xE0 && lead < 0xF0) return 3;
  if (lead >= 0xF0 && lead < 0xF5) return 4;
  return 0;
}

// Whether text[at, at + length) is one character: each further byte is 10xxxxxx, and the code has
// its shortest form, is no surrogate and is at most U+10FFFF.
bool is_character(std::string_view text, std::size_t at, std::size_t length) {
  if (length == 0 || at + length > text.size()) return false;
  std::uint32_t code = static_cast<unsigned char>(text[at]) & (length == 1 ? 0x7Fu : 0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    const auto byte = static_cast<unsigned char>(text[at + i]);
    if ((byte & 0xC0) != 0x80) return false;
    code = code << 6 | (byte & 0x3Fu);
  }
  constexpr std::uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  return code >= smallest[length] && code <= 0x10FFFF && !(code >= 0xD800 && code < 0xE000);
}

}  // namespace

std::size_t character_length(std::string_view text, std::size_t at) {
  const std::size_t length = sequence_length(static_cast<unsigned char>(text[at]));
  return is_character(text, at, length) ? length : 0;
}

void check_utf8(const std::string& name, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text, at);
    if (length == 0) {
      throw std::invalid_argument(
          fmt::format("text '{}': byte {} (0x{:02x}): must be UTF-8 without zero bytes", name, at,
                      static_cast<unsigned char>(text[at])));
    }
    at += length;
  }
}

}  // namespace frahm::results
