#pragma once

#include <string>

namespace frahm::studies {

// Whether a text stands for all names that it matches: `*` stands for any letters, as in "floor*_peak".
bool is_pattern(const std::string& text);

// Whether a name is the one given, or one that the pattern stands for.
bool matches(const std::string& name_or_pattern, const std::string& name);

}  // namespace frahm::studies
