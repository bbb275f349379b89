#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace frahm::studies {

// Text to add to a message about an unknown name: `; did you mean "stiffness"?` when one of the valid names
// is near (few letters changed, swapped, missing or added; case ignored), otherwise `; known: ...` when there
// are few enough to print, otherwise nothing.
std::string suggestion(std::string_view found, std::span<const std::string> valid);

// `no mass is called "mian"; did you mean "main"?`: what the valid names name, in the singular.
std::string none_called(std::string_view what, std::string_view found, std::span<const std::string> valid);

// The place of a name among others; nothing if it is none of them.
std::optional<std::size_t> place_among(std::span<const std::string> names, std::string_view name);

// Whether a name is of the form [A-Za-z][A-Za-z0-9_]*.
bool is_identifier(std::string_view name);

// `a`, `a or b`, `a, b or c`.
std::string listed(std::span<const std::string> words, std::string_view last_joint);

}  // namespace frahm::studies
