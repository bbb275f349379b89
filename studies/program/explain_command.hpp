#pragma once

#include <iosfwd>
#include <string>

namespace frahm::studies {

// Prints what a word of a study, of its results or of the program means: a key, a quantity (by its whole name
// or what stands after the owner's), a status, a regime or an exit code; all of them where it is several.
// Returns 0. Throws StudyError, with the nearest word, for one that is none of these.
int explain_command(const std::string& word, std::ostream& out);

}  // namespace frahm::studies
