#pragma once

#include <cstdint>
#include <functional>

// Pieces of work made by a team of threads, whose results are used in the order of the pieces.
namespace frahm::engine {

// Makes one piece and returns a function for its turn, which is called once and then destroyed. A PieceWork
// is used by one thread and may reuse its workspace.
using PieceWork = std::function<std::function<void()>(std::uint64_t piece)>;

// The most pieces per thread that are in work or wait for their turn: one slow piece does not make the other
// threads wait at once.
constexpr std::uint64_t most_pieces_a_thread = 3;

// Makes the pieces 0 ... pieces - 1 in a team of `threads` (0: default_threads())
// and calls the returned functions one after the other, in order: these need not be thread-safe. Memory is
// bounded: a thread that is too far ahead of the slowest piece waits.
// make_work: called once in each thread.  stop_asked: called before each piece, from several threads. Returns
// true if all pieces have had their turn, false after a stop, when only the first ones have. Throws the first
// exception of the work or of a turn; no further turn is taken then.
bool make_in_order(int threads, std::uint64_t pieces, const std::function<PieceWork()>& make_work,
                   const std::function<bool()>& stop_asked);

}  // namespace frahm::engine
