#include <exception>
#include <iostream>

#include "studies/program/exit_code.hpp"
#include "studies/program/program.hpp"

int main(int argc, char** argv) {
  try {
    return frahm::studies::run_program(argc, argv, std::cout);
  } catch (const std::exception& error) {
    std::cerr << "frahm: internal error, please report it: " << error.what() << '\n';
  } catch (...) {
    std::cerr << "frahm: internal error, please report it\n";
  }
  return frahm::studies::exit_code::internal_error;
}
