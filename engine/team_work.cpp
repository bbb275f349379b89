#include "engine/team_work.hpp"

#include <ctime>
#include <utility>

#include "engine/team.hpp"

namespace frahm::engine {

void TeamWork::compute(int threads, const StopAsked& stop_asked) {
  run_team(threads, [&](const std::atomic<bool>&) {
    try {
      take_part([&] { return has_failed() || stop_asked(); });
    } catch (...) {  // thrown on by rethrow_failure()
      fail(std::current_exception());
    }
  });
}

// The work of each thread: takes the next tile, computes it and saves it.
void TeamWork::take_part(const StopAsked& give_up) {
  const Kernel kernel = job_.make_kernel(give_up);
  Bytes entry;
  while (!give_up()) {
    const std::optional<std::uint64_t> tile = queue_.take();
    if (!tile) return;
    entry.clear();
    try {
      kernel(*tile, entry);
    } catch (const GivenUp&) {
      return;
    }
    log_.append(*tile, entry);
    if (job_.failed) failed_points_ += job_.failed(*tile, entry);
    points_ += job_.points(*tile);
    ++tiles_;
  }
}

void TeamWork::keep_on_disk() {
  try {
    log_.sync();
  } catch (...) {  // thrown on by rethrow_failure()
    fail(std::current_exception());
  }
}

void TeamWork::fail(std::exception_ptr error) {
  {
    const std::lock_guard turn(failure_turn_);
    if (!failure_) failure_ = std::move(error);
  }
  failed_ = true;
  queue_.drop();
}

void TeamWork::rethrow_failure() const {
  if (failure_) std::rethrow_exception(failure_);
}

Finished TeamWork::finished() const {
  const double cpu_seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  return {.tiles = tiles_,
          .points = points_,
          .reused = job_.reused ? job_.reused() : 0,
          .failed = failed_points_,
          .cpu_milliseconds = static_cast<std::uint64_t>(1e3 * cpu_seconds)};
}

}  // namespace frahm::engine
