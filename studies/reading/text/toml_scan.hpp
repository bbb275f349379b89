#pragma once

#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {

// Refuses a text that the TOML library must not see (throws StudyError with the position): over 1 MiB,
// control characters, letters beyond ASCII outside quotes and comments, brackets or dotted keys nested deeper
// than 16. Version 3.3 of toml++ runs into undefined behaviour on some of these, and recurses as deep as the
// text nests.
void scan_before_toml(const StudySource& source);

}  // namespace frahm::studies
