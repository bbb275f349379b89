#pragma once

#include <string>
#include <vector>

#include "studies/reading/toml_reading.hpp"

namespace frahm::studies {

// What has changed between the documents of two studies, a line for each, in the words of the later one's
// author: `element "spring": stiffness: 320 kN/m, now 330 kN/m`, `axis "speed": new`. Every key that the
// table of keys has is compared, by its place and name; tables of a list by what names them. Numbers with
// units are compared in SI, so 320 kN/m is 320000. Left out is what no result depends on: titles, [report]
// and coordinates beside the axes.  kept, now: TomlTables, their repetitions written out.
std::vector<std::string> document_changes(const TomlValue& kept, const TomlValue& now);

}  // namespace frahm::studies
