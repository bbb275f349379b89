#pragma once

#include <string>

#include "engine/run.hpp"

// The work of the ranks other than 0 in a parallel run, and the common end of all ranks.
namespace frahm::engine {

// Computes the tiles that rank 0 deals out and saves them in its own log; rank 0 calls run() with the same
// job and options. Returns the exit code with which rank 0 ends the program, even without a run if all was
// already computed. On SIGTERM, SIGINT or SIGUSR1 it leaves the run after the tiles in hand, and rank 0 then
// stops all. Throws std::invalid_argument, Locked, IoError and the first exception of a kernel; the caller
// then calls tell_failure().
int assist(const Job& job, const RunOptions& options);

// Reports to rank 0 that this rank cannot go on, and waits for it to end the program; returns the exit code.
int tell_failure(Ranks& ranks, const std::string& text, int code);

// Waits for rank 0 to end the program; returns the exit code.
int wait_for_end(Ranks& ranks);

// For rank 0: ends the program in all other ranks with the same exit code; does not return if one of them is
// given up.
void end_all(Ranks& ranks, int code);

}  // namespace frahm::engine
