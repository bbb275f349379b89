#pragma once

#include <span>
#include <string>
#include <vector>

namespace frahm::studies {

// Whether a text stands for all names that it matches. `*` stands for letters and digits, but no underscore:
// "floor*_peak" matches floor12_peak, and not floor12_velocity_peak.
bool is_pattern(const std::string& text);

// Whether a name is the one given, or one that the pattern stands for.
bool matches(const std::string& name_or_pattern, const std::string& name);

// The names that any of these names and patterns stands for: those of the first, those of the next, each
// once.
std::vector<std::string> matching(std::span<const std::string> names_or_patterns,
                                  std::span<const std::string> names);

// What a message says of a name or pattern that matches none of these: "; did you mean ...?", and where a
// star stops.
std::string hint_of_unmatched(const std::string& name_or_pattern, std::span<const std::string> names);

}  // namespace frahm::studies
