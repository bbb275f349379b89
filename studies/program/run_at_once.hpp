#pragma once

#include <iosfwd>

#include "studies/program/run_command.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Runs a study that is one piece of work: a motion (kind "decay" or "transient") or a model identified from
// data. Writes its file and prints a short table.
// This takes seconds at most, so nothing is saved on the way and a file of the same study is replaced; that
// of another study, or of other data, with --fresh alone. A run stopped by a signal or the time budget leaves
// no file.
// Returns 0; 4 if stopped; 7 if a fit did not converge. Throws as run_command().
int run_at_once(const RunCommandOptions& options, Study study, std::ostream& out);

}  // namespace frahm::studies
