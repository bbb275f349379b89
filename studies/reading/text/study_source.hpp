#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

#include "studies/reading/text/rules.hpp"

namespace frahm::studies {

// A position in the text of a study: line and column from 1, columns in characters. Line 0: none.
struct Position {
  std::size_t line = 0;
  std::size_t column = 0;

  friend auto operator<=>(const Position&, const Position&) = default;  // NOLINT(modernize-use-nullptr)
};

// A mistake in a study, reported to its author. what() is the whole message.
class StudyError : public std::runtime_error {
 public:
  template <class... Args>
  StudyError(Rule rule, fmt::format_string<Args...> message, Args&&... args)
      : StudyError(rule, Position{}, message, std::forward<Args>(args)...) {}
  template <class... Args>
  StudyError(Rule rule, Position position, fmt::format_string<Args...> message, Args&&... args)
      : std::runtime_error(fmt::format(message, std::forward<Args>(args)...)),
        rule_(rule),
        position_(position) {}
  Rule rule() const { return rule_; }
  Position position() const { return position_; }  // none where the mistake is not in the study's own text

 private:
  Rule rule_;
  Position position_;
};

// The text of a study and the name of its file, for the record and for messages.
struct StudySource {
  std::string name;
  std::string text;

  // The error `name:line:column: message`, with the line in question below it and a mark under the column.
  template <class... Args>
  StudyError error_at(Rule rule, Position position, fmt::format_string<Args...> message,
                      Args&&... args) const {
    return StudyError(rule, position, "{}",
                      placed(position, fmt::format(message, std::forward<Args>(args)...)));
  }

  // Position of the character `offset` (from 0) of the string value that starts at `string`; where the string
  // is written with escapes or over several lines, that of the string itself.
  Position inside_string(Position string, std::size_t offset) const;

 private:
  std::string placed(Position position, std::string_view message) const;
  std::string_view line(std::size_t number) const;
};

}  // namespace frahm::studies
