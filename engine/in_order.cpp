#include "engine/in_order.hpp"

#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "engine/team.hpp"

namespace frahm::engine {
namespace {

using Turn = std::function<void()>;

// Hands out pieces and takes their turns in order. All but the constructor is thread-safe.
class Pieces {
 public:
  Pieces(std::uint64_t pieces, std::uint64_t most_at_once) : pieces_(pieces), most_at_once_(most_at_once) {}

  // The next piece, as soon as it is not too far ahead; nothing when all are taken or the work has ended.
  std::optional<std::uint64_t> take() {
    std::unique_lock lock(mutex_);
    progress_.wait(lock, [this] { return ended_ || taken_ == pieces_ || taken_ < used_ + most_at_once_; });
    if (ended_ || taken_ == pieces_) return std::nullopt;
    return taken_++;
  }

  // Stores the turn of a piece; then takes all turns that are due, unless another thread is doing so.
  void give(std::uint64_t piece, Turn turn) {
    std::unique_lock lock(mutex_);
    waiting_.emplace(piece, std::move(turn));
    if (in_use_) return;
    in_use_ = true;
    while (!ended_ && !waiting_.empty() && waiting_.begin()->first == used_) {
      const Turn next = std::move(waiting_.extract(waiting_.begin()).mapped());
      lock.unlock();
      next();
      lock.lock();
      ++used_;
      progress_.notify_all();
    }
    in_use_ = false;
  }

  void end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    progress_.notify_all();
  }

  bool all_used() const { return used_ == pieces_; }  // when the team is done

 private:
  const std::uint64_t pieces_, most_at_once_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable progress_;
  std::uint64_t taken_ = 0, used_ = 0;
  bool in_use_ = false;  // by a thread that takes turns
  bool ended_ = false;   // by a stop or an exception
  std::map<std::uint64_t, Turn> waiting_;
};

// The work of each thread.
void make_pieces(Pieces& pieces, const std::function<PieceWork()>& make_work,
                 const std::function<bool()>& stop_asked) {
  try {
    const PieceWork work = make_work();
    while (const auto piece = pieces.take()) {
      if (stop_asked()) return pieces.end();
      pieces.give(*piece, work(*piece));
    }
  } catch (...) {
    pieces.end();  // wakes the threads that wait for a turn that will not come
    throw;
  }
}

}  // namespace

bool make_in_order(int threads, std::uint64_t pieces, const std::function<PieceWork()>& make_work,
                   const std::function<bool()>& stop_asked) {
  const int size = team_size(threads, pieces);
  Pieces shared(pieces, most_pieces_a_thread * static_cast<std::uint64_t>(size));
  const std::exception_ptr error =
      run_team(size, [&](const std::atomic<bool>&) { make_pieces(shared, make_work, stop_asked); });
  if (error) std::rethrow_exception(error);
  return shared.all_used();
}

}  // namespace frahm::engine
