#pragma once

#include <string>

#include "engine/run.hpp"

// The part of the ranks other than 0 in a parallel run, and how all end together.
namespace frahm::engine {

// Computes the tiles that rank 0, which calls run() with the same job and options, deals out, and keeps them
// in a log of its own. Returns the exit code with which rank 0 ends the program, which may be before there
// was a run: when all was computed already. On SIGTERM, SIGINT or SIGUSR1 it leaves the run after the tiles
// in hand, and rank 0 then stops all. Throws std::invalid_argument, Locked, IoError and the first exception
// of a kernel, after which tell_failure() is due.
int assist(const Job& job, const RunOptions& options);

// Tells rank 0 that this rank cannot go on, and waits for it to end the program; returns the exit code.
int tell_failure(Ranks& ranks, const std::string& text, int code);

// Waits for rank 0 to end the program; returns the exit code.
int wait_for_end(Ranks& ranks);

// Of rank 0: ends the program in all other ranks with the same exit code.
void end_all(Ranks& ranks, int code);

}  // namespace frahm::engine
