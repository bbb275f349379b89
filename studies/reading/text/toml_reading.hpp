#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {

struct TomlEntry;
struct TomlValue;

struct TomlDate {};  // a date or a time: legal TOML that no study uses
using TomlArray = std::vector<TomlValue>;
using TomlTable = std::vector<TomlEntry>;  // in the order of the file

// A value of a TOML document and its position.
struct TomlValue {
  Position position;
  std::variant<bool, std::int64_t, double, std::string, TomlDate, TomlArray, TomlTable> content;
  std::size_t number = 0;  // in its list, from 1, where others of the list may be left out

  template <class Type>
  const Type* as() const {
    return std::get_if<Type>(&content);
  }
};

struct TomlEntry {
  std::string key;
  Position position;  // of the key
  TomlValue value;
};

// A value described for messages: `the text "abc"`, `the number 3`, `an array`.
std::string described(const TomlValue& value);

// Reads the text of a study as a TOML document; its value is a TomlTable.
// Throws StudyError for what is not TOML, and for texts no study needs: over 1 MiB, nested deeper than 16,
// with control characters, or with letters beyond ASCII outside quotes and comments.
TomlValue read_toml(const StudySource& source);

}  // namespace frahm::studies
