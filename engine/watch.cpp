#include "engine/watch.hpp"

#include <utility>

namespace frahm::engine {

Watch::Watch(std::chrono::milliseconds period, std::function<void()> look)
    : period_(period), look_(std::move(look)), thread_([this] { keep_looking(); }) {}

Watch::~Watch() {
  end();
}

std::exception_ptr Watch::end() {
  {
    const std::lock_guard turn(turn_);
    ended_ = true;
  }
  ending_.notify_one();
  if (thread_.joinable()) thread_.join();
  return error_;
}

void Watch::keep_looking() {
  try {
    std::unique_lock turn(turn_);
    while (!ended_) {
      turn.unlock();
      look_();
      turn.lock();
      ending_.wait_for(turn, period_, [this] { return ended_; });
    }
  } catch (...) {  // returned by end()
    error_ = std::current_exception();
    failed_ = true;
  }
}

}  // namespace frahm::engine
