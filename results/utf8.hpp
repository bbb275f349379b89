#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace frahm::results {

// Throws std::invalid_argument if the text called `name` is not UTF-8 or contains a zero byte: a reader in
// Python could not open the file at all.
void check_utf8(const std::string& name, const std::string& text);

// Bytes of the character of a UTF-8 text that begins at `at`; 0: none begins there, or it is cut off.
std::size_t character_length(std::string_view text, std::size_t at);

}  // namespace frahm::results
