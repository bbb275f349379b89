#pragma once

#include <string>
#include <vector>

#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// What has changed between the documents of two studies, a line for each, in the words of the later one's
// author: `element "spring": stiffness: 320 kN/m, now 330 kN/m`, `axis "speed": new`. Every key that the
// table of keys has is compared, by its place and name; tables of a list by what names them. Numbers with
// units are compared in SI, so 320 kN/m is 320000. Left out is what no number depends on (Use::label), such
// as titles, and the order of parameters.  kept, now: TomlTables, their repetitions written out.
std::vector<std::string> document_changes(const TomlValue& kept, const TomlValue& now);

// All that is written in another way, titles and units too: 320 kN/m is not 320000.
std::vector<std::string> word_changes(const TomlValue& kept, const TomlValue& now);

// The numbers that are the same but for the rounding of their units, 300 rpm and 5 Hz, a line for each.
std::vector<std::string> rounding_changes(const TomlValue& kept, const TomlValue& now);

// The line of one. before, after: what each says.
std::string change_of_unit(const std::string& name, const std::string& before, const std::string& after);

}  // namespace frahm::studies
