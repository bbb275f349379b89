#include "studies/reading/text/toml_scan.hpp"

#include <fmt/format.h>

#include <string_view>

namespace frahm::studies {
namespace {

constexpr std::size_t longest_text = 1 << 20;  // bytes
constexpr std::size_t deepest_nesting = 16;    // a study needs 3

class Scan {
 public:
  explicit Scan(const StudySource& source) : source_(source), rest_(source.text) {}

  void run() {
    while (!rest_.empty()) {
      if (starts_string()) continue;
      const char c = rest_.front();
      if (c == '#') {
        skip_comment();
        continue;
      }
      if (static_cast<unsigned char>(c) >= 0x80U)
        fail(rules::not_text, "letters beyond ASCII are for quoted text and comments only");
      check_nesting(c);
      advance(1);
    }
  }

 private:
  [[noreturn]] void fail(Rule rule, std::string_view message) const {
    throw source_.error_at(rule, position_, "{}", message);
  }

  // Steps over bytes, refuses control characters and updates the position.
  void advance(std::size_t bytes) {
    for (; bytes > 0 && !rest_.empty(); --bytes, rest_.remove_prefix(1)) {
      const auto c = static_cast<unsigned char>(rest_.front());
      const bool line_end = c == '\r' && rest_.size() > 1 && rest_[1] == '\n';
      if ((c < 0x20U && c != '\t' && c != '\n' && !line_end) || c == 0x7FU) {
        fail(rules::not_text, fmt::format("the control character 0x{:02X} does not belong in a study", c));
      }
      if (c == '\n') {
        position_ = {position_.line + 1, 1};
      } else if ((c & 0xC0U) != 0x80U) {
        ++position_.column;
      }
    }
  }

  void skip_comment() {
    while (!rest_.empty() && rest_.front() != '\n') advance(1);
  }

  // Steps over a string if one starts here.
  bool starts_string() {
    for (const std::string_view quote : {"\"\"\"", "'''", "\"", "'"}) {
      if (!rest_.starts_with(quote)) continue;
      const bool one_line = quote.size() == 1;
      const bool escapes = quote.front() == '"';
      const Position start = position_;
      advance(quote.size());
      while (!rest_.empty() && !rest_.starts_with(quote) && !(one_line && rest_.front() == '\n')) {
        advance(escapes && rest_.front() == '\\' ? 2 : 1);
      }
      if (!rest_.starts_with(quote))
        throw source_.error_at(rules::not_text, start, "this text is never closed");
      advance(quote.size());
      return true;
    }
    return false;
  }

  void check_nesting(char c) {
    if (c == '[' || c == '{') ++brackets_;
    if ((c == ']' || c == '}') && brackets_ > 0) --brackets_;
    const bool separates = std::string_view("[]{},=\n").find(c) != std::string_view::npos;
    dots_ = separates ? 0 : dots_ + (c == '.');
    if (brackets_ > deepest_nesting || dots_ > deepest_nesting) {
      fail(rules::too_large, fmt::format("nested deeper than {} levels", deepest_nesting));
    }
  }

  const StudySource& source_;
  std::string_view rest_;
  Position position_{1, 1};
  std::size_t brackets_ = 0;
  std::size_t dots_ = 0;  // of the current dotted key or number
};

}  // namespace

void scan_before_toml(const StudySource& source) {
  if (source.text.size() > longest_text) {
    throw source.error_at(rules::too_large, {}, "is too long for a study, which has at most {} bytes",
                          longest_text);
  }
  Scan(source).run();
}

}  // namespace frahm::studies
