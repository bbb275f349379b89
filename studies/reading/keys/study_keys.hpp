#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace frahm::studies {

// What follows a key of a study. `value` is a number, an expression of parameters or { value, unit }.
enum class KeyForm {
  value,
  values,       // a list of those
  pairs,        // a list of pairs of those
  plain_value,  // a number or { value, unit }
  plain_pairs,  // a list of pairs of those
  column,       // of data: its number or its heading
  parameter,    // a value, or { table, of }
  number,       // a plain one
  numbers,      // a list of those
  integer,
  boolean,
  text,
  texts,
  expression,    // of parameters
  file,          // its name, relative to the folder of the study
  files,         // a list of those
  name,          // letters, digits and _, after a letter
  names,         // a list of those
  patterns,      // a list of those, or of patterns of them: "floor*_peak"
  choice,        // one of StudyKey::words
  element_type,  // the name of a type of element: element_types() has the words
  table,         // a section of its own, named `section.key`
  tables,        // [[section.key]], or a list of tables
  settings,      // a table whose keys are names that the author chooses: StudyKey::inside
  list_of_settings,
};

// What changes with a key (studies/provenance/fingerprint.hpp). Numbers and their units are of one use; the
// same numbers in other units change only how a result is written.
enum class Use {
  physics,  // what is computed
  grid,     // at which points, and what is computed next to them
  shown,    // what a finished result is compared with
  label,    // words and units of the file alone: a file with others gets them, and nothing is computed
  nowhere,  // nothing by itself, as a section whose keys count
};

// A word that a key may be.
struct StudyWord {
  const char* word = "";
  const char* meaning = "";
  const char* of = "";  // the forms of the section that know it: "a|b"; "": all
};

// Which forms of a section have a key, where not all have it.
struct KeyOwners {
  const char* decider = "";  // the key whose word is the form; "": what else is there decides
  const char* of = "";       // the forms: "a|b"; "": all
};

// The numbers that a key may be.
struct Limits {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above = false, below = false;  // least and most are none of them
  bool or_another = false;            // `another` is allowed too
  double another = 0.0;

  bool hold(double number) const;
  // "from 2 to 10000, or 0", "> 0".  kind: "a whole number ".
  std::string text(std::string_view kind = "") const;
};

inline constexpr Limits positive{.least = 0.0, .above = true};
inline constexpr Limits not_negative{.least = 0.0};

// How many entries a list or a table of settings has.
struct Length {
  std::size_t least = 1;
  std::size_t most = std::numeric_limits<std::size_t>::max();
};

// What a number, a whole number, a flag (1: true) or a choice (0: its first word) is where the key is left
// out.
struct Default {
  double value = 0.0;
};

// Forms of a section in which a key must be there.
struct Needed {
  bool always = false;
  KeyOwners of = {};
};

// What else than its form a key may be, and what the entries of settings are.
struct Or {
  KeyForm form{};
  const char* section = "";  // of a table, where it is not `section.key`
};
struct Inside {
  KeyForm form{};
};

// A key of a section of a study file. The table of them is what the readers allow (TomlSection), what
// `frahm schema` and `frahm explain` print.
struct StudyKey {
  // more: further properties, in any order.
  template <class... More>
  constexpr StudyKey(const char* in, const char* name, KeyForm what, Use changes, const char* what_it_means,
                     const More&... more)
      : section(in), key(name), form(what), use(changes), meaning(what_it_means) {
    (take(more), ...);
  }

  const char* section;  // "" for the sections themselves; "excitation.force"; "{ value, unit }" of values
  const char* key;
  KeyForm form;
  Use use;
  const char* meaning;
  std::span<const StudyWord> words{};  // of a choice: the first is the default, if there is one
  KeyOwners owners{};
  Needed need{};
  Limits limits{};  // of a number, and of all numbers of a list
  Length length{};
  std::optional<double> by_default{};  // none: nothing stands for it
  bool has_other = false;
  KeyForm other = KeyForm::value;  // where has_other
  const char* section_of_other = "";
  KeyForm inside = KeyForm::value;  // of settings

 private:
  constexpr void take(std::span<const StudyWord> choices) { words = choices; }
  constexpr void take(const KeyOwners& forms) { owners = forms; }
  constexpr void take(const Needed& forms) { need = forms; }
  constexpr void take(const Limits& numbers) { limits = numbers; }
  constexpr void take(const Length& entries) { length = entries; }
  constexpr void take(const Default& number) { by_default = number.value; }
  constexpr void take(const Or& second) {
    has_other = true, other = second.form, section_of_other = second.section;
  }
  constexpr void take(const Inside& entries) { inside = entries.form; }
};

std::span<const StudyKey> study_keys();

bool is_one_of(std::string_view word, std::string_view words);  // "a" of "a|b"
// Whether a word of the decider is among the owners.
bool has_by(const KeyOwners& owners, std::string_view decider, std::string_view form);
// Whether a form of the section has it, and must have it.
bool has(const StudyKey& key, std::string_view form);
bool needs(const StudyKey& key, std::string_view form);
// Throws std::logic_error if the section has no such key: a mistake of ours.
const StudyKey& study_key(std::string_view section, std::string_view key);

// The keys of a section, or of one form of it, in the order of the table.
std::vector<std::string> keys_of(std::string_view section, std::string_view form = "");
// The words of a key, or those that one form of its section knows.
std::vector<std::string> words_of(const StudyKey& key, std::string_view form = "");
// The forms of `a|b`.
std::vector<std::string> separated(std::string_view forms);

// "mass.name", "mass".
std::string path_of(const StudyKey& key);

// As a study writes it: "[decay]", "[[mass]]".
std::string written_section(const std::string& path);

}  // namespace frahm::studies
