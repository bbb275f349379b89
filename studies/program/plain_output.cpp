#include "studies/program/plain_output.hpp"

#include <algorithm>

#include "studies/reading/text/plain_text.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t handed_on_at = 1 << 12;  // [bytes]

// For a text, the bytes before a character at its end that may be cut off.
std::size_t whole_characters(const std::string& text) {
  const std::size_t longest = 4, from = text.size() - std::min(text.size(), longest - 1);
  for (std::size_t at = text.size(); at-- > from;) {
    const auto byte = static_cast<unsigned char>(text[at]);
    if (byte >= 0xC0U) return at;  // begins a character of several bytes
    if (byte < 0x80U) return text.size();
  }
  return text.size();
}

}  // namespace

void PlainOutput::Buffer::hand_on(std::size_t size) {
  const std::string plain = plain_text(std::string_view(waiting_).substr(0, size));
  to_.write(plain.data(), static_cast<std::streamsize>(plain.size()));
  waiting_.erase(0, size);
}

PlainOutput::Buffer::int_type PlainOutput::Buffer::overflow(int_type c) {
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  const char one = traits_type::to_char_type(c);
  return xsputn(&one, 1) == 1 ? c : traits_type::eof();
}

std::streamsize PlainOutput::Buffer::xsputn(const char* text, std::streamsize size) {
  waiting_.append(text, static_cast<std::size_t>(size));
  if (waiting_.size() >= handed_on_at) hand_on(whole_characters(waiting_));
  return to_ ? size : 0;
}

int PlainOutput::Buffer::sync() {
  hand_on(waiting_.size());
  to_.flush();
  return to_ ? 0 : -1;
}

}  // namespace frahm::studies
