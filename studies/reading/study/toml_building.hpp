#pragma once

#include <string>

#include "studies/reading/study/study.hpp"
#include "studies/reading/text/toml_reading.hpp"

// Values for a document to be written (toml_writing.hpp); they have no position in a text.
namespace frahm::studies {

TomlValue toml_number(double value);
TomlValue toml_string(const std::string& value);
TomlValue toml_with_unit(double value, const std::string& unit);  // { value = 3, unit = "mm" }

// A number parameter's value [SI] in its usual unit: 3, or { value = 3, unit = "mm" }.
TomlValue toml_parameter(const Study& study, std::size_t parameter, double si);

// The entry of a table that is being changed, nullptr if absent.
TomlEntry* entry_of(TomlTable& table, const std::string& key);

}  // namespace frahm::studies
