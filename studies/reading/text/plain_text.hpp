#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace frahm::studies {

// A text as it may be shown on a terminal: control characters (C0 but the line feed and the tab, DEL, C1) and
// bytes that are not UTF-8 become "?", so no title, name or note can move the cursor, change colours or type.
std::string plain_text(std::string_view text);

// A text for a message: what is longer than so many bytes is cut between two characters, and ends in "...".
std::string shortened(std::string_view text, std::size_t most);

// Whether a text is UTF-8 without any control character: a path or an option that can be printed, stored and
// read.
bool is_plain_line(std::string_view text);

}  // namespace frahm::studies
