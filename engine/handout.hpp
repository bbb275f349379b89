#pragma once

#include <cstdint>

namespace frahm::engine {

// The number of tiles that a rank gets per request: a quarter of its share (by threads) of the tiles left, so
// that blocks shrink towards the end and all ranks finish together (guided self-scheduling,
// C. D. Polychronopoulos and D. J. Kuck, IEEE Trans. Comput. 36 (1987)), at most 64 for each of its threads
// and at least one. left: > 0.  threads: of the rank, > 0.  all_threads: of all ranks, >= threads.
std::uint64_t block_size(std::uint64_t left, int threads, int all_threads);

}  // namespace frahm::engine
