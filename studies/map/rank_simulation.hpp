#pragma once

#include <cstdint>
#include <span>
#include <vector>

// The predicted time of a map on many ranks: the dealing of its tiles is replayed event by event with
// measured costs.
//
// Rank 0 serves one request after the other, each with a block of tiles (engine/handout.hpp). A rank asks as
// soon as its queue is empty, that is when its last thread has taken the last tile of its block, and is
// answered while the threads compute the tiles they have in hand. When all tiles are done rank 0 assembles
// the file, with the processors of all ranks on its machine (engine/README.md).
namespace frahm::studies {

// Consecutive tiles of equal cost in one thread.
struct CostRun {
  std::uint64_t tiles = 0;
  double seconds = 0.0;
};

// A tile of a sample and its cost in one thread.
struct TileCost {
  std::uint64_t tile = 0;
  double seconds = 0.0;
};

// The cost of each of `tiles` tiles, that of the nearest one of the sample.  sample: not empty, in any order,
// each tile once and below `tiles`.
std::vector<CostRun> costs_of_all(std::vector<TileCost> sample, std::uint64_t tiles);

// All times in seconds.
struct RankCosts {
  std::vector<CostRun> tiles;  // in the order of their numbers
  double start = 0.0;          // until a rank has read the study and asks
  double assembly = 0.0;       // of the file, by one thread
  int processors = 1;          // of a machine, which holds as many ranks as have their threads there
  double service = 7e-6;       // of a request, by rank 0: two-sided Open MPI on one machine, measured
  double answer = 1e-3;        // until a rank looks for its answer: its pause between two looks
};

// Shares of `wall` x cores; efficiency and all shares make 1.
struct RankPrediction {
  double wall = 0.0;        // [s]
  double efficiency = 0.0;  // spent on tiles
  double start = 0.0;
  double waiting = 0.0;        // of threads for tiles that rank 0 has not handed out yet
  double imbalance = 0.0;      // of threads that find none left while others compute their last
  double assembly = 0.0;       // idle cores of other machines, and the work on that of rank 0
  std::uint64_t requests = 0;  // that were answered with tiles
};

// Threads that assemble the file: of the ranks on the machine of rank 0, no more than the one that writes can
// follow.
int assembling_threads(int processors, int ranks, int threads);

// ranks, threads of each: > 0.  Time O(tiles log threads + requests log ranks), memory O(ranks x threads).
RankPrediction simulate_ranks(const RankCosts& costs, int ranks, int threads);

// The largest number of ranks, at most `most`, with an efficiency of at least `least`, which is assumed to
// fall with the number of ranks; 0 if one rank is already below it.
int ranks_with_efficiency(const RankCosts& costs, int threads, double least, int most);

}  // namespace frahm::studies
