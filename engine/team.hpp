#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>

#include "engine/ranks.hpp"

namespace frahm::engine {

// The default number of threads of this process: OMP_NUM_THREADS, otherwise the processors a Slurm task was
// given (SLURM_CPUS_PER_TASK), otherwise those that this process may use. ranks: among which it is; null if
// alone.
int default_threads(const Ranks* ranks = nullptr);

// The number of threads for these pieces of work: `wanted` (0: default_threads()), but no more than pieces,
// and at least one.
int team_size(int wanted, std::uint64_t pieces);

// Calls work(failed) once in each of `threads` (> 0) OpenMP threads and returns when all calls have.
// Returns the first exception of a call, null if none; `failed` is true from that exception on, so that the
// others can stop early. Further exceptions are dropped.
std::exception_ptr run_team(int threads, const std::function<void(const std::atomic<bool>& failed)>& work);

}  // namespace frahm::engine
