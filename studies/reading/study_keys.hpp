#pragma once

#include <span>
#include <string>

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
  choice,  // one of the words of StudyKey::words
  table,   // a section of its own, named `section.key`
  tables,  // [[section.key]], or a list of tables
  names,   // a table whose keys are names that the author chooses
  any,     // several of these
};

// A key of a section of a study file. Every key that any kind of study reads is in the table, once for each
// section; the readers add which go together, and what must be there.
struct StudyKey {
  const char* section;  // "" for the sections themselves; "excitation.force"
  const char* key;
  KeyForm form;
  const char* meaning;
  const char* words = "";  // of a choice: "a|b"
};

std::span<const StudyKey> study_keys();

// As a study writes it: "[decay]", "[[mass]]".
std::string written_section(const std::string& path);

}  // namespace frahm::studies
