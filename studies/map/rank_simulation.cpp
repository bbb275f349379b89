#include "studies/map/rank_simulation.hpp"

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>

#include "engine/handout.hpp"

namespace frahm::studies {
namespace {

std::uint64_t tiles_of(const std::vector<CostRun>& runs) {
  std::uint64_t tiles = 0;
  for (const CostRun& run : runs) tiles += run.tiles;
  return tiles;
}

double seconds_of(const std::vector<CostRun>& runs) {
  double seconds = 0.0;
  for (const CostRun& run : runs) seconds += static_cast<double>(run.tiles) * run.seconds;
  return seconds;
}

// Goes through the tiles in the order of their numbers.
class TileWalk {
 public:
  explicit TileWalk(const std::vector<CostRun>& runs) : runs_(runs) {}

  double next() {
    while (used_ == runs_[run_].tiles) {
      ++run_;
      used_ = 0;
    }
    ++used_;
    return runs_[run_].seconds;
  }

 private:
  const std::vector<CostRun>& runs_;
  std::size_t run_ = 0;
  std::uint64_t used_ = 0;
};

struct Request {
  double time = 0.0;
  int rank = 0;

  friend bool operator>(const Request& a, const Request& b) {
    return std::tie(a.time, a.rank) > std::tie(b.time, b.rank);
  }
};

// The times at which the threads of one rank are free, as a heap with the earliest in front.
using FreeTimes = std::vector<double>;

// Threads take the tiles of a block that arrives at `time`, each the next one when it is free. Adds to
// `waiting` their waiting time for the block; returns the time when the last tile is taken.
double compute_block(std::uint64_t block, double time, TileWalk& tiles, FreeTimes& free, double& waiting) {
  double taken = time;
  for (std::uint64_t i = 0; i < block; ++i) {
    std::pop_heap(free.begin(), free.end(), std::greater<>());
    taken = std::max(free.back(), time);
    waiting += taken - free.back();
    free.back() = taken + tiles.next();
    std::push_heap(free.begin(), free.end(), std::greater<>());
  }
  return taken;
}

// The time of the threads between the first request and the end of the last tile.
struct Computation {
  double span = 0.0;       // [s]
  double waiting = 0.0;    // [core s]
  double imbalance = 0.0;  // [core s]
  std::uint64_t requests = 0;
};

Computation compute(const RankCosts& costs, int ranks, int threads) {
  std::vector<FreeTimes> free(static_cast<std::size_t>(ranks),
                              FreeTimes(static_cast<std::size_t>(threads), 0.0));
  std::priority_queue<Request, std::vector<Request>, std::greater<>> requests;
  for (int rank = 0; rank < ranks; ++rank) requests.push({0.0, rank});
  TileWalk tiles(costs.tiles);
  std::uint64_t left = tiles_of(costs.tiles);
  Computation done;
  double served = 0.0;  // when rank 0 has served the previous request
  while (left > 0) {
    const Request request = requests.top();
    requests.pop();
    served = std::max(served, request.time) + costs.service;
    const std::uint64_t block = engine::block_size(left, threads, ranks * threads);
    left -= block;
    const double arrival = request.rank == 0 ? served : served + costs.answer;
    FreeTimes& own = free[static_cast<std::size_t>(request.rank)];
    requests.push({compute_block(block, arrival, tiles, own, done.waiting), request.rank});
    ++done.requests;
  }
  for (const FreeTimes& own : free)
    done.span = std::max(done.span, *std::max_element(own.begin(), own.end()));
  for (const FreeTimes& own : free) {
    for (const double time : own) done.imbalance += done.span - time;
  }
  return done;
}

}  // namespace

std::vector<CostRun> costs_of_all(std::vector<TileCost> sample, std::uint64_t tiles) {
  std::ranges::sort(sample, {}, &TileCost::tile);
  std::vector<CostRun> runs;
  std::uint64_t from = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const std::uint64_t to = i + 1 < sample.size() ? (sample[i].tile + sample[i + 1].tile) / 2 + 1 : tiles;
    runs.push_back({to - from, sample[i].seconds});
    from = to;
  }
  return runs;
}

int assembling_threads(int processors, int ranks, int threads) {
  constexpr int most = 12;  // beyond 4 to 12 the writer of HDF5 is the limit (engine/README.md)
  const int ranks_on_machine = std::min(ranks, std::max(1, processors / threads));
  return std::min(most, ranks_on_machine * threads);
}

RankPrediction simulate_ranks(const RankCosts& costs, int ranks, int threads) {
  const Computation done = compute(costs, ranks, threads);
  const double cores = static_cast<double>(ranks) * threads;
  const double assembly = costs.assembly / assembling_threads(costs.processors, ranks, threads);
  RankPrediction prediction{.wall = costs.start + done.span + assembly};
  const double all = prediction.wall * cores;
  prediction.efficiency = seconds_of(costs.tiles) / all;
  prediction.start = costs.start * cores / all;
  prediction.waiting = done.waiting / all;
  prediction.imbalance = done.imbalance / all;
  prediction.assembly = assembly * cores / all;
  prediction.requests = done.requests;
  return prediction;
}

int ranks_with_efficiency(const RankCosts& costs, int threads, double least, int most) {
  const auto is_enough = [&](int ranks) { return simulate_ranks(costs, ranks, threads).efficiency >= least; };
  if (is_enough(most)) return most;
  int low = 0, high = most;  // efficient enough (or 0 ranks), not enough
  while (high - low > 1) {
    // Small numbers count by ratio too: 1, 2, 4 ... until the first that is not enough.
    const int middle = high == most ? std::min(std::max(1, 2 * low), (low + high) / 2) : (low + high) / 2;
    (is_enough(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace frahm::studies
