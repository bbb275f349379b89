#include "engine/assist.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <thread>

#include "engine/io_error.hpp"
#include "engine/rank_message.hpp"
#include "engine/shard_log.hpp"
#include "engine/stop_signals.hpp"
#include "engine/team.hpp"
#include "engine/team_work.hpp"
#include "engine/watch.hpp"

namespace frahm::engine {
namespace {

using Clock = std::chrono::steady_clock;
using Kind = RankMessage::Kind;
using namespace std::chrono_literals;

constexpr std::chrono::seconds report_every(1);  // rank 0 shows the progress of all
constexpr std::chrono::seconds synced_every(1);

// The next message of rank 0. It is polled with pauses: MPI itself would wait at full speed.
RankMessage next_message(Ranks& ranks) {
  for (;;) {
    if (const auto message = ranks.receive()) return decode(message->bytes);
    std::this_thread::sleep_for(2ms);
  }
}

// The conversation with rank 0 while the team computes.
class Asking {
 public:
  Asking(Ranks& ranks, TeamWork& work) : ranks_(ranks), work_(work) {}

  // Handles the messages received, asks for tiles when none are left, and reports progress now and then.
  void look(bool stop_asked) {
    while (const auto message = ranks_.receive()) take_in(decode(message->bytes));
    if (stop_asked) drop();
    if (is_open_ && !has_asked_ && work_.queue().is_empty()) {
      has_asked_ = true;
      tell(Kind::ask);
    }
    if (Clock::now() - reported_at_ >= report_every) tell(Kind::tell);
  }

 private:
  void take_in(const RankMessage& message) {
    has_asked_ = false;
    if (message.kind == Kind::deal) work_.queue().add(message.tiles);
    if (message.kind == Kind::stop) drop();
    if (message.kind == Kind::close) {
      is_open_ = false;
      work_.queue().close();
    }
  }
  void drop() {
    is_open_ = false;
    work_.queue().drop();
  }
  void tell(Kind kind) {
    ranks_.send(0, encode({.kind = kind, .finished = work_.finished()}));
    reported_at_ = Clock::now();
  }

  Ranks& ranks_;
  TeamWork& work_;
  bool is_open_ = true, has_asked_ = false;
  Clock::time_point reported_at_ = Clock::now();
};

// Returns the finished counts once the log is closed and on the disk.
Finished compute_tiles(const Job& job, const RunOptions& options, int threads, const StopSignals& signals) {
  const LogHeader study{.fingerprint = job.fingerprint, .tiles = job.tiles};
  ShardLog log(own_log(options), study);
  TeamWork work(job, log);
  const auto stop_asked = [&] { return work.has_failed() || signals.received() != 0; };
  {
    Asking asking(*options.ranks, work);
    const Watch conversation(2ms, [&] { asking.look(stop_asked()); });
    const Watch syncing(synced_every, [&] { work.keep_on_disk(); });
    work.compute(threads, stop_asked);
  }
  work.keep_on_disk();
  work.rethrow_failure();
  return work.finished();
}

}  // namespace

int assist(const Job& job, const RunOptions& options) {
  Ranks& ranks = *options.ranks;
  // Also while rank 0 assembles: a launcher passes signals on to all ranks, and one that dies ends them all.
  const StopSignals signals;
  const int threads = options.threads > 0 ? options.threads : default_threads(&ranks);
  const std::uint64_t study = study_mark({.fingerprint = job.fingerprint, .tiles = job.tiles});
  ranks.send(
      0,
      encode({.kind = Kind::ready, .threads = static_cast<std::uint64_t>(threads), .text = this_process()}));
  const RankMessage first = next_message(ranks);
  if (first.kind == Kind::end) return static_cast<int>(first.code);

  RankMessage leaving{.kind = Kind::leave};
  if (first.kind == Kind::begin) {
    if (first.study != study)
      throw IoError(options.output,
                    "belongs to another study, or to another version of this program, on rank 0");
    leaving.finished = compute_tiles(job, options, threads, signals);
    if (signals.received() != 0) leaving.text = "stopped by " + signal_name(signals.received());
  }
  ranks.send(0, encode(leaving));
  return wait_for_end(ranks);
}

int tell_failure(Ranks& ranks, const std::string& text, int code) {
  ranks.send(0, encode({.kind = Kind::fail, .code = static_cast<std::uint64_t>(code), .text = text}));
  return wait_for_end(ranks);
}

int wait_for_end(Ranks& ranks) {
  for (;;) {
    const RankMessage message = next_message(ranks);
    if (message.kind == Kind::end) return static_cast<int>(message.code);
  }
}

void end_all(Ranks& ranks, int code) {
  for (int rank = 1; rank < ranks.size(); ++rank)
    ranks.send(rank, encode({.kind = Kind::end, .code = static_cast<std::uint64_t>(code)}));
  ranks.end_without_given_up(code);
}

}  // namespace frahm::engine
