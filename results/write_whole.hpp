#pragma once

#include <string_view>

namespace frahm::results {

// Writes the text to a descriptor to its last byte, however often the system stops in between. Returns 0,
// else the errno of the call that failed.
int write_whole(int descriptor, std::string_view text);

}  // namespace frahm::results
