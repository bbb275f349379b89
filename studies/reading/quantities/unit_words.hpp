#pragma once

#include <string>

namespace frahm::studies {

// How numbers and names are written with their units. A pure number, of the unit "1" or "", is written
// without.
bool is_pure_number(const std::string& unit);
std::string with_unit(const std::string& number, const std::string& unit);  // `3.2 mm`
std::string with_unit(double number, const std::string& unit);              // with as few digits as say it
std::string in_brackets(const std::string& name, const std::string& unit);  // `stroke [mm]`

}  // namespace frahm::studies
