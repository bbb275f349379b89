#pragma once

#include <cstdint>
#include <functional>

// Pieces of work made by a team of threads, whose results are used in the order of the pieces.
namespace frahm::engine {

// Makes one piece and returns what is to be done with it when its turn comes: called once and destroyed then.
// It is used by one thread and may keep its workspace.
using PieceWork = std::function<std::function<void()>(std::uint64_t piece)>;

// Pieces of each thread that are in the making or wait for their turn, at most: one slow piece does not make
// the other threads wait at once.
constexpr std::uint64_t most_pieces_a_thread = 3;

// Makes the pieces 0 ... pieces - 1 in a team of `threads` (0: default_threads())
// and calls what they return one after the other, in their order: what is done in turn need not be
// thread-safe. Memory is bounded: a thread that is too far ahead of the slowest piece waits.
// make_work: called once in each thread.  stop_asked: looked at before each piece, from several threads.
// Returns whether all pieces have had their turn; false when it was asked to stop: the first ones have then.
// Throws what the work, or what is done in turn, throws first; no further turn is taken then.
bool make_in_order(int threads, std::uint64_t pieces, const std::function<PieceWork()>& make_work,
                   const std::function<bool()>& stop_asked);

}  // namespace frahm::engine
