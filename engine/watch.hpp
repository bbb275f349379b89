#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace frahm::engine {

// Calls `look` again and again in a thread of its own: slow work on disk and terminal that no worker shall
// wait for.
class Watch {
 public:
  Watch(std::chrono::milliseconds period, std::function<void()> look);
  ~Watch();  // ends the thread
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  // Whether `look` has thrown; it is not called again then.
  bool failed() const { return failed_; }
  // Ends the thread; returns what `look` threw, null if nothing.
  std::exception_ptr end();

 private:
  void keep_looking();

  std::chrono::milliseconds period_;
  std::function<void()> look_;
  std::mutex turn_;  // guards ended_
  std::condition_variable ending_;
  bool ended_ = false;
  std::atomic<bool> failed_ = false;
  std::exception_ptr error_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace frahm::engine
