#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace frahm::engine {

// Calls `look` again and again in a thread of its own, with a pause of `period` between: for slow work on
// disk, terminal and network; once at least, however soon it ends. `look` must not throw.
class Watch {
 public:
  Watch(std::chrono::milliseconds period, std::function<void()> look);
  ~Watch();  // ends it
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  void end();  // returns when `look` has returned for the last time

 private:
  void keep_looking();

  std::chrono::milliseconds period_;
  std::function<void()> look_;
  std::mutex turn_;  // guards ended_
  std::condition_variable ending_;
  bool ended_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace frahm::engine
