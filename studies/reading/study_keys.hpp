#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace frahm::studies {

// What stands behind a key of a study. `value` is a number, an expression of parameters or { value, unit }.
enum class KeyForm {
  value,
  values,  // a list of those
  number,  // a plain one
  integer,
  boolean,
  text,
  texts,
  choice,        // one of StudyKey::words
  element_type,  // the name of a type of element: element_types() has the words
  table,         // a section of its own, named `section.key`
  tables,        // [[section.key]], or a list of tables
  names,         // a table whose keys are names that the author chooses
  any,           // several of these; of texts StudyKey::words, if it has any
};

// A word that a key may be.
struct StudyWord {
  const char* word;
  const char* meaning;
  const char* of = "";  // the forms of the section that know it: "a|b"; "": all
};

// Which forms of a section have a key, where not all have it.
struct KeyOwners {
  const char* decider = "";  // the key whose word is the form; "": what else is there decides
  const char* of = "";       // the forms: "a|b"; "": all
};

// A key of a section of a study file. The table of them is what the readers allow (TomlSection), what
// `frahm schema` prints and what `frahm explain` tells.
struct StudyKey {
  constexpr StudyKey(const char* in, const char* name, KeyForm what, const char* told, KeyOwners of = {})
      : StudyKey(in, name, what, told, {}, of) {}
  constexpr StudyKey(const char* in, const char* name, KeyForm what, const char* told,
                     std::span<const StudyWord> choices, KeyOwners of = {})
      : section(in), key(name), form(what), meaning(told), words(choices), owners(of) {}

  const char* section;  // "" for the sections themselves; "excitation.force"; "{ value, unit }" of values
  const char* key;
  KeyForm form;
  const char* meaning;
  std::span<const StudyWord> words;  // of a choice: the first is the default, if there is one
  KeyOwners owners;
};

std::span<const StudyKey> study_keys();

// Whether a form of the section has it.
bool has(const StudyKey& key, std::string_view form);
// Throws std::logic_error if the section has no such key: a mistake of ours.
const StudyKey& study_key(std::string_view section, std::string_view key);

// The keys of a section, or of one form of it, in the order of the table.
std::vector<std::string> keys_of(std::string_view section, std::string_view form = "");
// The words of a key, or those that one form of its section knows.
std::vector<std::string> words_of(const StudyKey& key, std::string_view form = "");
// The forms of `a|b`.
std::vector<std::string> separated(std::string_view forms);

// As a study writes it: "[decay]", "[[mass]]".
std::string written_section(const std::string& path);

}  // namespace frahm::studies
