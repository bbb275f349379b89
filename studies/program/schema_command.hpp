#pragma once

#include <iosfwd>

namespace frahm::studies {

// Prints the JSON Schema (draft 2020-12) of study files, from the table of their keys (study_keys.hpp). What
// a schema cannot tell (which keys go together, units, expressions, names) frahm check prints. Returns 0.
int schema_command(std::ostream& out);

}  // namespace frahm::studies
