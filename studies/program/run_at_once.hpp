#pragma once

#include <iosfwd>

#include "studies/program/run_command.hpp"
#include "studies/reading/study.hpp"

namespace frahm::studies {

// What is one piece of work: the motion of a study of kind "decay" or "transient", or a model identified from
// data. Writes its file and prints a short table.
// It takes seconds at most, so nothing is kept in between and a file of the same study is written anew.
// A signal or the time budget stops it: then it leaves no file. Returns 0; 4 if stopped; 7 if a fit did not
// converge. Throws as run_command().
int run_at_once(const RunCommandOptions& options, Study study, std::ostream& out);

}  // namespace frahm::studies
