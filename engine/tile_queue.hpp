#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>

namespace frahm::engine {

// Tiles in the order in which they are computed, filled from one side and emptied by the threads of a team.
class TileQueue {
 public:
  void add(std::span<const std::uint64_t> tiles);
  // No more tiles will be added.
  void close();
  // Drops the remaining tiles and closes: the threads end with the tiles they have in hand.
  void drop();

  // The next tile; waits for one while the queue is open. Nothing: the queue is closed and empty.
  std::optional<std::uint64_t> take();

  bool is_empty() const;

 private:
  mutable std::mutex turn_;  // guards the members below
  std::condition_variable changed_;
  std::deque<std::uint64_t> tiles_;
  bool open_ = true;
};

}  // namespace frahm::engine
