#include "engine/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "engine/shard_log.hpp"
#include "engine/stop_signals.hpp"
#include "engine/team.hpp"
#include "engine/watch.hpp"

namespace frahm::engine {
namespace {

using Clock = std::chrono::steady_clock;

void check(const RunOptions& options) {
  if (options.shard.count == 0 || options.shard.index >= options.shard.count) {
    throw std::invalid_argument(fmt::format("shard {}/{}: the index must be below the count, from 0 on",
                                            options.shard.index, options.shard.count));
  }
  if (options.threads < 0) {
    throw std::invalid_argument(fmt::format("threads = {}: must be >= 0", options.threads));
  }
  if (options.time_budget && !(options.time_budget->count() > 0.0)) {
    throw std::invalid_argument(
        fmt::format("time budget of {} s: must be > 0", options.time_budget->count()));
  }
}

std::filesystem::path own_log(const RunOptions& options) {
  return log_path(options.output, fmt::format("shard-{}-of-{}", options.shard.index, options.shard.count));
}

// Removes what RunOptions::fresh says.
void discard_logs(const RunOptions& options, const LogHeader& study) {
  std::vector<std::filesystem::path> logs = find_logs(options.output);
  if (options.shard.count > 1) {
    std::erase_if(logs,
                  [&](const auto& log) { return log != own_log(options) && study_of_log(log) == study; });
  }
  remove_logs(logs);
}

// What is left of the shard's tiles when the logs beside the output have been read.
struct Remainder {
  std::vector<std::uint64_t> tiles;  // in order
  Summary so_far;                    // counts what the logs keep
};

Remainder read_logs(const Job& job, const RunOptions& options, const LogHeader& study) {
  const Shard& shard = options.shard;
  Remainder remainder;
  Summary& summary = remainder.so_far;
  const auto take_up = [&](std::uint64_t tile, std::span<const std::byte> record) {
    if (tile % shard.count != shard.index) return;
    ++summary.tiles_resumed;
    summary.points.resumed += job.points(tile);
    if (job.failed) summary.points.failed += job.failed(tile, record);
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

// What the threads of a run share.
struct Work {
  const Job& job;
  const std::vector<std::uint64_t>& tiles;  // to do
  ShardLog& log;
  std::atomic<std::size_t> next = 0;  // the first of `tiles` that nobody has taken
  // Finished by this run:
  std::atomic<std::uint64_t> finished_tiles = 0;
  std::atomic<std::uint64_t> finished_points = 0;
  std::atomic<std::uint64_t> failed_points = 0;
};

// What each thread does: takes the next tile, computes it and keeps it, until none is left or give_up().
void compute_tiles(Work& work, const StopAsked& give_up) {
  const Job& job = work.job;
  const Kernel kernel = job.make_kernel(give_up);
  Bytes record;
  while (!give_up()) {
    const std::size_t taken = work.next++;
    if (taken >= work.tiles.size()) return;
    const std::uint64_t tile = work.tiles[taken];
    record.clear();
    try {
      kernel(tile, record);
    } catch (const GivenUp&) {
      return;
    }
    work.log.append(tile, record);
    if (job.failed) work.failed_points += job.failed(tile, record);
    work.finished_points += job.points(tile);
    ++work.finished_tiles;
  }
}

// Draws the progress at each call, and once a second brings what is finished to the disk.
std::function<void()> keep_up(Progress& progress, ShardLog& log, std::function<Tally()> tally) {
  return [&progress, &log, tally = std::move(tally), last_sync = Clock::now()]() mutable {
    progress.update(tally());
    if (Clock::now() - last_sync < std::chrono::seconds(1)) return;
    log.sync();
    last_sync = Clock::now();
  };
}

std::string stop_reason(const StopSignals& signals, const RunOptions& options) {
  if (signals.received() != 0) return "stopped by " + signal_name(signals.received());
  return fmt::format("the time budget of {} s is used up", options.time_budget->count());
}

}  // namespace

Summary run(const Job& job, const RunOptions& options) {
  check(options);
  const Clock::time_point start = Clock::now();
  const auto elapsed = [start] { return std::chrono::duration<double>(Clock::now() - start); };
  const StopSignals signals;
  const auto stop_asked = [&] {
    return signals.received() != 0 || (options.time_budget && elapsed() >= *options.time_budget);
  };

  const LogHeader study{.fingerprint = job.fingerprint, .tiles = job.tiles};
  if (options.fresh) discard_logs(options, study);
  ShardLog log(own_log(options), study);
  auto [tiles, summary] = read_logs(job, options, study);
  if (const LogExtent& found = log.found(); found.unused_bytes() > 0) {
    summary.unused.push_back({own_log(options), found.good_bytes, found.unused_bytes()});
  }

  Work work{.job = job, .tiles = tiles, .log = log};
  const auto tally = [&work, &found = summary.points] {
    Tally now = found;
    now.done += work.finished_points;
    now.failed += work.failed_points;
    return now;
  };
  Progress progress(progress_form(options.progress), std::cerr);
  Watch watch(std::chrono::milliseconds(100), keep_up(progress, log, tally));
  summary.threads = team_size(options.threads, tiles.size());
  const std::exception_ptr team_error = run_team(summary.threads, [&](const std::atomic<bool>& failed) {
    compute_tiles(work, [&] { return failed || watch.failed() || stop_asked(); });
  });
  const std::exception_ptr watch_error = watch.end();
  progress.finish(tally());
  if (watch_error) std::rethrow_exception(watch_error);
  log.sync();
  if (team_error) std::rethrow_exception(team_error);

  summary.points = tally();
  summary.tiles_computed = work.finished_tiles;
  summary.seconds = elapsed().count();
  const bool all = summary.tiles_computed == tiles.size();
  summary.outcome = all ? Outcome::complete : Outcome::stopped;
  summary.reason = all ? "every tile is finished" : stop_reason(signals, options);
  return summary;
}

}  // namespace frahm::engine
