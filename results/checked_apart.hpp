#pragma once

#include <filesystem>

#include "results/file_check.hpp"

namespace frahm::results {

// Carries out a check of a file in a child process, which may die of it: HDF5 1.10 cannot survive every
// damaged file. Throws StoreError with the text of the one that the check threw; or, naming the file, if the
// child was ended by a signal or needed more than 20 s of processor time or 1 GiB of memory.
//
// In a process that must not fork it is carried out by another program (check_by), or in the process itself
// (keep_checks_here).
void check_apart(const std::filesystem::path& path, const FileCheck& check);

// From now on this process does not fork. For ranks of MPI: memory that a network card has registered is torn
// from a process that forks and then writes to it, so messages would be lost without an error.
void keep_checks_here();

// From now on this process does not fork but starts this program, which calls be_checking_program(). For
// Python: a child of a process with other threads, of which one may be inside HDF5, might wait for ever.
void check_by(const std::filesystem::path& program);

// What that program does: carries out the check with these words, answers at its standard output, and ends.
[[noreturn]] void be_checking_program(const std::vector<std::string>& words);

}  // namespace frahm::results
