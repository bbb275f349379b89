#include "engine/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <thread>
#include <unordered_set>
#include <utility>

#include "engine/dealer.hpp"
#include "engine/io_error.hpp"
#include "engine/shard_log.hpp"
#include "engine/stop_request.hpp"
#include "engine/team.hpp"
#include "engine/team_work.hpp"
#include "engine/watch.hpp"

namespace frahm::engine {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

void check(const RunOptions& options) {
  if (options.shard.count == 0 || options.shard.index >= options.shard.count) {
    throw std::invalid_argument(
        fmt::format("shard {}/{}: the index must be below the count; it starts from 0", options.shard.index,
                    options.shard.count));
  }
  if (options.threads < 0) {
    throw std::invalid_argument(fmt::format("threads = {}: must be >= 0", options.threads));
  }
  if (options.time_budget && !(options.time_budget->count() > 0.0)) {
    throw std::invalid_argument(
        fmt::format("time budget of {} s: must be > 0", options.time_budget->count()));
  }
  if (!(options.rank_silence.count() > 0.0)) {
    throw std::invalid_argument(
        fmt::format("rank silence of {} s: must be > 0", options.rank_silence.count()));
  }
}

// Removes the logs named by RunOptions::fresh.
void discard_logs(const RunOptions& options, const LogHeader& study) {
  std::vector<std::filesystem::path> logs = find_logs(options.output);
  if (options.shard.count > 1) {
    std::erase_if(logs,
                  [&](const auto& log) { return log != own_log(options) && study_of_log(log) == study; });
  }
  remove_logs(logs);
}

// The tiles of the shard that are missing in the logs next to the output.
struct Remainder {
  std::vector<std::uint64_t> tiles;  // in order
  Summary so_far;                    // counts of the logs
};

Remainder read_logs(const Job& job, const RunOptions& options, const LogHeader& study) {
  const Shard& shard = options.shard;
  Remainder remainder;
  Summary& summary = remainder.so_far;
  const auto take_up = [&](std::uint64_t tile, std::span<const std::byte> entry) {
    if (tile % shard.count != shard.index) return;
    if (job.check) job.check(tile, entry);
    ++summary.tiles_resumed;
    summary.points.resumed += job.points(tile);
    if (job.failed) summary.points.failed += job.failed(tile, entry);
  };
  const TileIndex index = index_tiles(find_logs(options.output), study, take_up);
  for (std::uint64_t tile = shard.index; tile < study.tiles; tile += shard.count) {
    ++summary.tiles;
    summary.points.points += job.points(tile);
    if (!index.has(tile)) remainder.tiles.push_back(tile);
  }
  summary.points.done = summary.points.resumed;
  summary.unused = index.unused;
  return remainder;
}

std::filesystem::path log_of_rank(const RunOptions& options, int rank) {
  return log_path(options.output, fmt::format("shard-{}-of-{}{}", options.shard.index, options.shard.count,
                                              rank > 0 ? fmt::format("-rank-{}", rank) : ""));
}

// What the log of a frozen rank has of its tiles. If it cannot be read they are all missing; the assembly
// will say why.
Salvage read_log_of_rank(const Job& job, const RunOptions& options, const LogHeader& study, int rank,
                         const std::vector<std::uint64_t>& tiles) {
  std::unordered_set<std::uint64_t> missing(tiles.begin(), tiles.end());
  Finished finished;
  const auto take_up = [&](std::uint64_t tile, std::span<const std::byte> entry) {
    if (missing.erase(tile) == 0) return;  // of an earlier run
    if (job.check) job.check(tile, entry);
    ++finished.tiles;
    finished.points += job.points(tile);
    if (job.failed) finished.failed += job.failed(tile, entry);
  };
  try {
    index_tiles({log_of_rank(options, rank)}, study, take_up);
  } catch (const IoError&) {
    return {.missing = tiles, .finished = {}};
  }
  Salvage left{.missing = {}, .finished = finished};
  std::ranges::copy_if(tiles, std::back_inserter(left.missing),
                       [&](std::uint64_t tile) { return missing.contains(tile); });
  return left;
}

// The progress of the whole run.
Tally tally_of(const Tally& found, const Job& job, const TeamWork& work,
               const std::optional<Dealer>& dealer) {
  Finished finished = work.finished();
  if (dealer) finished += dealer->finished();
  Tally now = found;
  now.done += finished.points;
  now.reused += finished.reused;
  now.failed += finished.failed;
  if (job.evaluations) now.evaluations = job.evaluations();
  return now;
}

// While it exists, rank 0 serves the other ranks in addition to its own work. Without other ranks it does
// nothing.
class Attendance {
 public:
  Attendance(std::optional<Dealer>& dealer, StopAsked stop_asked) : dealer_(dealer) {
    if (dealer) watch_.emplace(2ms, [&dealer, stop = std::move(stop_asked)] { dealer->serve(stop()); });
  }
  // Returns when the others have left.
  void wait() const {
    while (dealer_ && !dealer_->all_have_left()) std::this_thread::sleep_for(1ms);
  }

 private:
  std::optional<Dealer>& dealer_;
  std::optional<Watch> watch_;
};

// Alone, a process has all tiles in its queue at once. Among ranks they are dealt out.
std::optional<Dealer> supply(const Job& job, const RunOptions& options, const LogHeader& study, int threads,
                             const std::vector<std::uint64_t>& tiles, TileQueue& queue) {
  if (options.ranks) {
    const auto salvage = [&job, &options, study](int rank, const std::vector<std::uint64_t>& dealt) {
      return read_log_of_rank(job, options, study, rank, dealt);
    };
    return std::optional<Dealer>(std::in_place, *options.ranks, study_mark(study), threads, tiles, queue,
                                 Silence{.longest = options.rank_silence, .salvage = salvage});
  }
  queue.add(tiles);
  queue.close();
  return std::nullopt;
}

// Adds the counts of this run to a summary.
void count(const Job& job, const TeamWork& work, const std::optional<Dealer>& dealer, int threads,
           Ranks* ranks, Summary& summary) {
  const Finished elsewhere = dealer ? dealer->finished() : Finished{};
  summary.points = tally_of(summary.points, job, work, dealer);
  summary.tiles_computed = work.finished().tiles + elsewhere.tiles;
  summary.cpu_seconds_elsewhere = 1e-3 * static_cast<double>(elsewhere.cpu_milliseconds);
  summary.threads = dealer ? dealer->threads() : threads;
  summary.ranks = ranks ? ranks->size() : 1;
  summary.threads_here = threads * (ranks ? ranks->take_machine() : 1);
}

}  // namespace

Summary run(const Job& job, const RunOptions& options) {
  check(options);
  const Clock::time_point start = Clock::now();
  const StopRequest stop(options.time_budget, start - options.begun, options.called_off);
  const LogHeader study{.fingerprint = job.fingerprint, .tiles = job.tiles};
  if (options.fresh) discard_logs(options, study);
  ShardLog log(own_log(options), study);
  auto [tiles, summary] = read_logs(job, options, study);
  if (const LogExtent& found = log.found(); found.unused_bytes() > 0) {
    summary.unused.push_back({own_log(options), found.good_bytes, found.unused_bytes()});
  }

  TeamWork work(job, log);
  const int wanted = options.threads > 0 ? options.threads : default_threads(options.ranks);
  const int threads = team_size(wanted, tiles.size());
  std::optional<Dealer> dealer = supply(job, options, study, threads, tiles, work.queue());
  const auto give_up = [&] { return work.has_failed() || stop.asked(); };
  const auto tally = [&, &found = summary.points] { return tally_of(found, job, work, dealer); };
  Progress progress(progress_form(options.progress), std::cerr, Clock::now, {}, job.counted);
  {
    const Watch showing(100ms, [&] {
      if (dealer) progress.note(dealer->take_notices());
      progress.update(tally());
    });
    const Watch syncing(1s, [&] { work.keep_on_disk(); });
    const Attendance others(dealer, give_up);
    work.compute(threads, give_up);
    others.wait();
  }
  work.keep_on_disk();
  if (dealer) progress.note(dealer->take_notices());
  progress.finish(tally());
  work.rethrow_failure();
  if (dealer) dealer->rethrow_failure();

  count(job, work, dealer, threads, options.ranks, summary);
  summary.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const bool all = summary.tiles_computed == tiles.size();
  summary.outcome = all ? Outcome::complete : Outcome::stopped;
  summary.reason = all ? "every tile is finished" : stop.reason();
  if (summary.reason.empty()) summary.reason = dealer->stop_reason();  // another rank stopped
  return summary;
}

std::filesystem::path own_log(const RunOptions& options) {
  const int rank = options.ranks ? options.ranks->rank() : 0;
  return log_of_rank(options, rank);
}

}  // namespace frahm::engine
