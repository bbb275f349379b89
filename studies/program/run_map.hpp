#pragma once

#include <iosfwd>

#include "studies/program/run_command.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Computes the map of a study of kind "sweep", or its missing tiles, and writes its file. Prints a short
// table of it. Returns 0; 3 if some points failed; 4 if stopped. Throws as run_command().
int run_map(const RunCommandOptions& options, Study study, std::ostream& out);

}  // namespace frahm::studies
