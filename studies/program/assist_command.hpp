#pragma once

#include "studies/program/run_command.hpp"

namespace frahm::studies {

// `frahm run` on a rank other than 0: helps rank 0 compute the study, or waits if that is one piece of work.
// Returns the exit code with which rank 0 ends the program. Throws as engine::assist() and StudyError.
int assist_command(const RunCommandOptions& options);

}  // namespace frahm::studies
