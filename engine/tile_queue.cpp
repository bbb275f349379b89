#include "engine/tile_queue.hpp"

namespace frahm::engine {

void TileQueue::add(std::span<const std::uint64_t> tiles) {
  {
    const std::lock_guard turn(turn_);
    tiles_.insert(tiles_.end(), tiles.begin(), tiles.end());
  }
  changed_.notify_all();
}

void TileQueue::close() {
  {
    const std::lock_guard turn(turn_);
    open_ = false;
  }
  changed_.notify_all();
}

void TileQueue::drop() {
  {
    const std::lock_guard turn(turn_);
    tiles_.clear();
    open_ = false;
  }
  changed_.notify_all();
}

std::optional<std::uint64_t> TileQueue::take() {
  std::unique_lock turn(turn_);
  changed_.wait(turn, [this] { return !tiles_.empty() || !open_; });
  if (tiles_.empty()) return std::nullopt;
  const std::uint64_t tile = tiles_.front();
  tiles_.pop_front();
  return tile;
}

bool TileQueue::is_empty() const {
  const std::lock_guard turn(turn_);
  return tiles_.empty();
}

}  // namespace frahm::engine
