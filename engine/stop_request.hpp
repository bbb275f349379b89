#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

#include "engine/stop_signals.hpp"

namespace frahm::engine {

// A request to end a piece of work early: a signal (engine/stop_signals), the end of a time budget, of which
// a part may be used already, or a flag that somebody sets (null: nobody). Only one may exist at a time, as
// with StopSignals.
class StopRequest {
 public:
  using Seconds = std::chrono::duration<double>;

  explicit StopRequest(std::optional<Seconds> budget, Seconds used = Seconds(0.0),
                       const std::atomic<bool>* called_off = nullptr)
      : budget_(budget), used_(used), called_off_(called_off) {}

  bool asked() const;
  Seconds elapsed() const { return used_ + (std::chrono::steady_clock::now() - start_); }
  // "stopped by SIGTERM", "the time budget of 60 s is used up"; empty if nothing was asked.
  std::string reason() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::optional<Seconds> budget_;
  Seconds used_;
  const std::atomic<bool>* called_off_;
  StopSignals signals_;
};

}  // namespace frahm::engine
