#pragma once

#include <iosfwd>

namespace frahm::studies {

// The program: reads the command line, carries out its command and returns the exit code (exit_code.hpp).
// Data go to `out`, progress and errors to stderr. Throws only what is a fault of the program itself.
int run_program(int argc, const char* const* argv, std::ostream& out);

}  // namespace frahm::studies
