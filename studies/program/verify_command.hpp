#pragma once

#include <iosfwd>

namespace frahm::studies {

// Solves the classical cases that have closed forms and prints a table: the worst deviation of each, what is
// allowed, pass or FAIL. Returns 0, or 8 if any case fails.
int verify_command(std::ostream& out);

}  // namespace frahm::studies
