#include "results/checked_apart.hpp"

// The program next to the module that reads a file which may be damaged before the interpreter does.
int main(int argc, char** argv) {
  frahm::results::be_checking_program({argv + 1, argv + argc});
}
