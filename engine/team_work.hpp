#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>

#include "engine/rank_message.hpp"
#include "engine/run.hpp"
#include "engine/shard_log.hpp"
#include "engine/tile_queue.hpp"

namespace frahm::engine {

// Shared by the threads of one process while they compute tiles: the queue of tiles, the log of finished ones
// and their counts.
class TeamWork {
 public:
  // job, log: must outlive it.
  TeamWork(const Job& job, ShardLog& log) : job_(job), log_(log) {}

  TileQueue& queue() { return queue_; }

  // Computes the tiles of the queue in `threads` threads and saves each finished tile, until the queue is
  // closed and empty, stop_asked(), or an error.
  void compute(int threads, const StopAsked& stop_asked);

  // Syncs the finished tiles to the disk; a failure is an error of the work.
  void keep_on_disk();

  // Whether there was an error: the work ends after the tiles in hand.
  bool has_failed() const { return failed_; }
  void rethrow_failure() const;  // the first one, if there was one

  Finished finished() const;

 private:
  void take_part(const StopAsked& give_up);
  void fail(std::exception_ptr error);

  const Job& job_;
  ShardLog& log_;
  TileQueue queue_;
  std::atomic<std::uint64_t> tiles_ = 0, points_ = 0, failed_points_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex failure_turn_;
  std::exception_ptr failure_;
};

}  // namespace frahm::engine
