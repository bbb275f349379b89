#include "engine/watch.hpp"

#include <utility>

namespace frahm::engine {

Watch::Watch(std::chrono::milliseconds period, std::function<void()> look)
    : period_(period), look_(std::move(look)), thread_([this] { keep_looking(); }) {}

Watch::~Watch() {
  end();
}

void Watch::end() {
  {
    const std::lock_guard turn(turn_);
    ended_ = true;
  }
  ending_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Watch::keep_looking() {
  std::unique_lock turn(turn_);
  do {
    turn.unlock();
    look_();
    turn.lock();
    ending_.wait_for(turn, period_, [this] { return ended_; });
  } while (!ended_);
}

}  // namespace frahm::engine
