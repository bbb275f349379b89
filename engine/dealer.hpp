#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
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

// What is left of the tiles that were dealt to a rank.
struct Salvage {
  std::vector<std::uint64_t> missing;  // in no entry of its log
  Finished finished;                   // the others: tiles, points and failed ones
};

// A rank speaks once a second. One that says nothing for so long is taken for frozen: what its log lacks is
// dealt out again, and whatever it does later does not count.
struct Silence {
  std::chrono::duration<double> longest{60.0};
  std::function<Salvage(int rank, const std::vector<std::uint64_t>& tiles)> salvage;  // reads its log
};

// Rank 0 deals out the tiles that are to be computed to all ranks, itself among them, in blocks
// (engine/handout), as they ask for them. Its own queue stays open until the others have left or are frozen:
// what a frozen rank has not finished may be left for rank 0 alone.
class Dealer {
 public:
  using Clock = std::chrono::steady_clock;

  // study: its mark, by which each rank checks that it has the same study.  threads: of rank 0.  tiles: to be
  // computed, in order.  own: the queue of rank 0.
  Dealer(Ranks& ranks, std::uint64_t study, int threads, std::vector<std::uint64_t> tiles, TileQueue& own,
         Silence silence);

  // Answers all messages that have come, gives up ranks that are silent, and fills the own queue when it is
  // empty; called again and again by one thread until all_have_left(). stop_asked: no more tiles are dealt
  // out, and the others get `stop`.
  void serve(bool stop_asked, Clock::time_point now = Clock::now());

  // Whether no other rank computes or will compute any more, frozen ones aside.
  bool all_have_left() const { return present_ == 0; }

  // The functions below may be called from other threads.
  Finished finished() const;        // by the other ranks, as last reported
  int threads() const;              // of all ranks
  std::string stop_reason() const;  // of the first rank that was stopped by itself; empty if none was
  // A sentence for each rank that was given up since the last call.
  std::vector<std::string> take_notices();

  // Throws RankFailed for the first rank that failed, if one has.
  void rethrow_failure() const;

 private:
  struct Member {
    std::string name;  // "rank 3 (process 4711 on node17)"
    int threads = 0;   // 0: no message yet
    bool at_work = false, has_left = false;
    bool is_given_up = false;               // was silent for too long
    std::chrono::duration<double> heard{};  // last, by awake_
    std::vector<std::uint64_t> tiles = {};  // dealt to it
    Finished finished = {};
  };

  void pass_time(Clock::time_point now);
  void answer(int rank, const RankMessage& message);
  void answer_late(int rank, const RankMessage& message);
  void give_up_silent();
  void give_up(int rank);
  void welcome(int rank, const RankMessage& message);
  void deal_to(int rank);
  void fill_own();
  void stop();
  void leave(Member& member);
  std::vector<std::uint64_t> take_block(Member& member);
  int expected_threads() const;

  Ranks& ranks_;
  std::uint64_t study_;
  std::vector<std::uint64_t> tiles_;
  std::size_t next_ = 0;  // of tiles_
  TileQueue& own_;
  bool own_is_closed_ = false, stopping_ = false;
  Silence silence_;
  // How long this rank has served, without the times in which it was frozen itself and could hear nobody.
  std::chrono::duration<double> awake_{};
  std::optional<Clock::time_point> served_;  // last
  std::atomic<int> present_;
  mutable std::mutex turn_;  // guards the members below
  std::vector<Member> members_;
  std::string stop_reason_;
  std::vector<std::string> notices_;
  std::optional<RankFailed> failure_;
};

}  // namespace frahm::engine
