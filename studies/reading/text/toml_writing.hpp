#pragma once

#include <string>

#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// A document as text that read_toml() reads to the same values: tables and arrays of tables under their own
// headings, two deep, the rest in line. root: a TomlTable without dates.
std::string toml_text(const TomlValue& root);

// A value in line, as it stands after a key: `[1, 2]`, `{ value = 3, unit = "mm" }`.
std::string toml_in_line(const TomlValue& value);

}  // namespace frahm::studies
