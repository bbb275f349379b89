#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/rank_message.hpp"
#include "engine/ranks.hpp"
#include "engine/tile_queue.hpp"

namespace frahm::engine {

// Another rank could not go on. The text begins with the rank, its process and machine.
class RankFailed : public std::runtime_error {
 public:
  RankFailed(const std::string& text, int code) : std::runtime_error(text), code_(code) {}
  int code() const { return code_; }  // with which the program shall end

 private:
  int code_;
};

// Rank 0 deals out the tiles that are to be computed to all ranks, itself among them, in blocks
// (engine/handout), as they ask for them.
class Dealer {
 public:
  // study: its mark, by which each rank checks that it has the same study.  threads: of rank 0.  tiles: to be
  // computed, in order.  own: the queue of rank 0.
  Dealer(Ranks& ranks, std::uint64_t study, int threads, std::vector<std::uint64_t> tiles, TileQueue& own);

  // Answers all messages that have come, and fills the own queue when it is empty; called again and again by
  // one thread until all_have_left(). stop_asked: no more tiles are dealt out, and the others get `stop`.
  void serve(bool stop_asked);

  // Whether no other rank computes or will compute any more.
  bool all_have_left() const { return present_ == 0; }

  // The functions below may be called from other threads.
  Finished finished() const;        // by the other ranks, as last reported
  int threads() const;              // of all ranks
  std::string stop_reason() const;  // of the first rank that was stopped by itself; empty if none was

  // Throws RankFailed for the first rank that failed, if one has.
  void rethrow_failure() const;

 private:
  struct Member {
    std::string name;  // "rank 3 (process 4711 on node17)"
    int threads = 0;   // 0: no message yet
    bool at_work = false, has_left = false;
    Finished finished = {};
  };

  void answer(int rank, const RankMessage& message);
  void welcome(int rank, const RankMessage& message);
  void deal_to(int rank);
  void fill_own();
  void stop();
  void leave(Member& member);
  std::vector<std::uint64_t> take_block(int threads);
  int expected_threads() const;

  Ranks& ranks_;
  std::uint64_t study_;
  std::vector<std::uint64_t> tiles_;
  std::size_t next_ = 0;  // of tiles_
  TileQueue& own_;
  bool own_is_closed_ = false, stopping_ = false;
  std::atomic<int> present_;
  mutable std::mutex turn_;  // guards the members below
  std::vector<Member> members_;
  std::string stop_reason_;
  std::optional<RankFailed> failure_;
};

}  // namespace frahm::engine
