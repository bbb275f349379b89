#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/bytes.hpp"
#include "engine/fingerprint.hpp"
#include "engine/progress.hpp"
#include "engine/ranks.hpp"
#include "engine/tile_index.hpp"

// Computes the tiles of a job with a team of threads and saves each finished tile in a shard log.
//
// Thread teams, ranks, array tasks and resumed runs are all writers of shards: their joint result does not
// depend on who computed which tile, in what order, or how often they were stopped.
namespace frahm::engine {

// Computes one tile and writes its entry to `out`, which is empty before the call. The entry must depend on
// the tile alone. A kernel is used by one thread and may reuse its workspace.
using Kernel = std::function<void(std::uint64_t tile, Bytes& out)>;

// Whether the run has been asked to stop: by a signal, the time budget, or an error in another thread. A
// kernel with long tiles checks this and gives up its tile by throwing GivenUp: nothing of the tile is saved.
using StopAsked = std::function<bool()>;
struct GivenUp {};

struct Job {
  std::uint64_t tiles = 0;
  Fingerprint fingerprint;
  // The functions below are called from several threads at once.
  // Called once in each thread; the kernel may store its argument.
  std::function<Kernel(const StopAsked& stop_asked)> make_kernel;
  std::function<std::uint64_t(std::uint64_t tile)> points;  // points of a tile
  // Points of a finished tile that have no result; may be empty: all have one.
  std::function<std::uint64_t(std::uint64_t tile, std::span<const std::byte> entry)> failed;
  // Throws BadEntry for an entry out of a log that the kernel did not write; may be empty: all are good.
  std::function<void(std::uint64_t tile, std::span<const std::byte> entry)> check = {};
  // Points that the kernels of this process took from an earlier result; may be empty.
  std::function<std::uint64_t()> reused = {};
  // How often the kernels of this process have computed a model, where a tile takes many such evaluations and
  // long; may be empty.
  std::function<std::uint64_t()> evaluations = {};
  std::string counted = "points";  // what the points are called
};

// The part of the tiles a run computes: those with tile % count == index. Needs index < count.
struct Shard {
  std::uint64_t index = 0;
  std::uint64_t count = 1;
};

struct RunOptions {
  std::filesystem::path output;  // the file to be assembled later; the logs lie next to it
  int threads = 0;               // of each process, >= 0; 0: default_threads()
  Shard shard{};
  // Discard what earlier runs left: all logs; for one shard of several its own log and those of other
  // studies, because the other shards of this study may be at work or done.
  bool fresh = false;
  std::optional<std::chrono::duration<double>> time_budget{};  // > 0, from `begun`; absent: none
  // Whether somebody other than signals and the budget asks for a stop, as a function of Python that shows
  // progress; it outlives the run. Null: nobody.
  const std::atomic<bool>* called_off = nullptr;
  // When the program began, as far as it knows; otherwise when the options were made.
  std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();
  ProgressStyle progress = ProgressStyle::automatic;
  Ranks* ranks = nullptr;  // the ranks of the program; null: this process works alone
  // A rank that says nothing for so long is not waited for (engine/dealer); > 0. At work it speaks every
  // second.
  std::chrono::duration<double> rank_silence{60.0};
};

enum class Outcome {
  complete,  // every tile of the shard is in a log
  stopped,   // by a signal or the time budget; the same run again resumes from there
};

// Tiles and points are those of the shard.
struct Summary {
  Outcome outcome = Outcome::complete;
  std::string reason;  // why it ended, as a sentence
  std::uint64_t tiles = 0;
  std::uint64_t tiles_resumed = 0;  // found in logs
  std::uint64_t tiles_computed = 0;
  Tally points;
  int threads = 0;  // of all ranks
  int ranks = 1;
  int threads_here = 0;                // of this machine, for the work left when all ranks are done
  double seconds = 0.0;                // wall time of it
  double cpu_seconds_elsewhere = 0.0;  // of the other ranks
  std::vector<UnusedBytes> unused;     // ends of logs that could not be used when the run began
};

// Computes the tiles of the shard that are in no log next to the output yet; among ranks it is called by rank
// 0, deals the tiles out to all, and returns when the others have closed their logs (engine/assist). On
// SIGTERM, SIGINT, SIGUSR1 or at the end of the time budget the tiles in hand are finished or given up by
// their kernels; finished tiles are on the disk at the end in every case. One run at a time in a process.
// Throws std::invalid_argument for options outside their range, ResumeRefused when tiles of another study lie
// next to the output (unless fresh), Locked when another process computes this shard, IoError, and, once the
// tiles in hand are saved, the first exception of a kernel; RankFailed (engine/dealer) when another rank
// could not go on.
Summary run(const Job& job, const RunOptions& options);

// The log of this process: <output>.shard-i-of-n[-rank-k].frahm-log, without a rank's number for rank 0.
std::filesystem::path own_log(const RunOptions& options);

}  // namespace frahm::engine
