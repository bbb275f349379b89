#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

struct KeyGroup;
struct Limits;
struct StudyKey;

// A table of the study with the keys that study_keys() gives it, and its values by type. Every function
// throws a StudyError with the position, what was found and what is allowed.
class TomlSection {
 public:
  // where: the table's name in messages: `[study]`, `element "guide"`. section: its name in study_keys();
  // form: the form of the section, if that is known before its keys are read. The first key that these have
  // not is an error, and so is one that they need and is not there, and a group of keys (key_groups.hpp) that
  // is broken.
  TomlSection(const StudySource& source, const TomlValue& table, std::string where, std::string_view section,
              std::string_view form = "");

  const StudySource& source() const { return *source_; }
  Position position() const { return table_->position; }
  const std::string& where() const { return where_; }

  const TomlValue* find(std::string_view key) const;     // nullptr if absent
  const TomlValue& require(std::string_view key) const;  // an error if absent
  std::string text(std::string_view key) const;          // required, not empty, without control characters
  std::string text_or(std::string_view key, std::string otherwise) const;
  std::string identifier(std::string_view key) const;  // required, of the form [A-Za-z][A-Za-z0-9_]*
  // Finite, within the limits of the table of keys; if absent, its default there, otherwise required.
  double number(std::string_view key) const;
  std::int64_t integer(std::string_view key) const;
  bool boolean(std::string_view key) const;
  // One of the words of the table of keys; if absent `otherwise`, or the first of them. besides: what else
  // the key can be, for the message.
  std::string choice(std::string_view key, std::string_view otherwise = "",
                     std::string_view besides = "") const;
  // Likewise as an enumerator, where these stand in the order of the words.
  template <class Enum>
  Enum choice_as(std::string_view key) const {
    return static_cast<Enum>(place_of(key, choice(key)));
  }

  const Limits& limits(std::string_view key) const;  // of the table of keys

  // Refuses keys that another form of the section has and this one has not, requires its own and checks its
  // groups, once a key has told the form.
  void keep_to(std::string_view form) const;

  // At the table, and at the value of a key.
  template <class... Args>
  [[noreturn]] void fail_here(Rule rule, fmt::format_string<Args...> message, Args&&... args) const {
    throw source_->error_at(rule, position(), "{}: {}", where_,
                            fmt::format(message, std::forward<Args>(args)...));
  }
  template <class... Args>
  [[noreturn]] void fail(Rule rule, std::string_view key, fmt::format_string<Args...> message,
                         Args&&... args) const {
    throw source_->error_at(rule, require(key).position, "{}: {}: {}", where_, key,
                            fmt::format(message, std::forward<Args>(args)...));
  }

 private:
  void check_limits(std::string_view key, double number, std::string_view kind) const;
  std::optional<double> default_of_absent(std::string_view key) const;
  void require_keys(std::string_view form) const;
  void check_groups(std::string_view form) const;
  void check_group(const KeyGroup& group) const;
  std::size_t place_of(std::string_view key, std::string_view word) const;

  const StudySource* source_;
  const TomlValue* table_;
  std::string where_;
  std::string section_, form_;
};

// The single forms of what TomlSection reads; `where` names the value in messages.
std::string read_text(const StudySource& source, const std::string& where, const TomlValue& value);
std::string read_identifier(const StudySource& source, const std::string& where, const TomlValue& value);
double read_number(const StudySource& source, const std::string& where, const TomlValue& value);
bool is_number(const TomlValue& value);

// Names of a list, each once, as places among those known. what: these name, for messages: "mass".
std::vector<std::size_t> read_places(const TomlSection& section, std::string_view key, const TomlArray& names,
                                     std::string_view what, const std::vector<std::string>& known);

// The tables of `[[path]]`, such as "mass" or "excitation.force", in the parent that holds its last part;
// none if the key is absent.
std::vector<const TomlValue*> read_tables(const StudySource& source, const TomlValue& parent,
                                          const std::string& path);

// The name of one of several tables in messages: `element "guide"` by the text of its naming key, otherwise
// `[[element]] 3`. number: from 1.
std::string label(const TomlValue& table, std::string_view kind, std::string_view naming_key,
                  std::string_view path, std::size_t number);

// Whether a table has a key; an empty list of tables is none.
bool is_given(const StudyKey& key, const TomlValue& table);

// An entry of a table, nullptr if absent.
const TomlEntry* find_entry(const TomlValue& table, std::string_view key);

}  // namespace frahm::studies
