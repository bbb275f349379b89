#pragma once

#include <string>

namespace frahm::results {

// Throws std::invalid_argument if the text called `name` is not UTF-8 or contains a zero byte: a reader in
// Python could not open the file at all.
void check_utf8(const std::string& name, const std::string& text);

}  // namespace frahm::results
