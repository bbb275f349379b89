#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace frahm::studies {

// The end of another program.
struct ProgramEnd {
  bool found = true;        // whether there is such a program on the PATH
  int code = 0;             // its exit code; 128 + the signal that ended it
  std::string output = {};  // what it wrote to standard output
};

// Runs a program, found by its name on the PATH, without a shell; it shares our standard error.
// arguments: without the name.  input: for its standard input.  Throws std::system_error.
ProgramEnd run_program_of_system(const std::string& name, const std::vector<std::string>& arguments,
                                 std::string_view input = {});

}  // namespace frahm::studies
