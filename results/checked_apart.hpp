#pragma once

#include <filesystem>
#include <functional>

namespace frahm::results {

// Carries out a check of a file in a child process, which may die of it: HDF5 1.10 cannot survive every
// damaged file. Throws StoreError with the text of the one that `check` threw; or, naming the file, if the
// child was ended by a signal or needed more than 20 s of processor time or 1 GiB of memory.
//
// In a process that must not fork (keep_checks_here) `check` is carried out in the process itself.
void check_apart(const std::filesystem::path& path, const std::function<void()>& check);

// From now on this process does not fork. For ranks of MPI: memory that a network card has registered is torn
// from a process that forks and then writes to it, so messages would be lost without an error.
void keep_checks_here();

}  // namespace frahm::results
