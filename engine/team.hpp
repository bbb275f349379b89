#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>

namespace frahm::engine {

// Threads for so many pieces of work: `wanted` (0: one on each processor this process may use), but no more
// than pieces, and at least one.
int team_size(int wanted, std::uint64_t pieces);

// Calls work(failed) once in each of `threads` (> 0) OpenMP threads and returns when all calls have.
// Returns the first exception of a call, null if none; `failed` is true from that exception on, so that the
// others can stop early. Further exceptions are dropped.
std::exception_ptr run_team(int threads, const std::function<void(const std::atomic<bool>& failed)>& work);

}  // namespace frahm::engine
