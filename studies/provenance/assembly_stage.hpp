#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "engine/in_order.hpp"
#include "engine/progress.hpp"
#include "engine/watch.hpp"
#include "studies/provenance/assembly_options.hpp"

namespace frahm::studies {

// The progress of a part of an assembly, on stderr if it takes longer than a second. Ends its line when it is
// destroyed.
class StageProgress {
 public:
  // name: "writing".  points: to do in all.
  StageProgress(const std::string& name, std::uint64_t points, engine::ProgressStyle style);
  ~StageProgress();
  StageProgress(const StageProgress&) = delete;
  StageProgress& operator=(const StageProgress&) = delete;

  void add(std::uint64_t points) { done_ += points; }  // from any thread

 private:
  engine::Tally tally() const { return {.points = points_, .done = done_}; }
  void look();

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::uint64_t points_;
  std::atomic<std::uint64_t> done_ = 0;
  engine::Progress progress_;
  bool shown_ = false;
  engine::Watch watch_;  // last: it uses all of the above
};

// A part of an assembly: pieces made by a team of threads, and used in their order.
struct AssemblyStage {
  std::string name;                      // for the progress: "writing"
  std::uint64_t pieces = 0, points = 0;  // in all
  std::function<std::uint64_t(std::uint64_t piece)> points_of;
  std::function<engine::PieceWork()> make_work;  // called once in each thread
};

// Removes the logs of a file once the file is complete. A log still in use by a running shard stays; a note
// on stderr says so.
void remove_used_logs(const AssemblyOptions& options);

// An assembly was asked to stop.
struct AssemblyStopped {};

// Carries out a stage and shows its progress. Throws AssemblyStopped and the exceptions of the work.
void carry_out(const AssemblyStage& stage, const AssemblyOptions& options);

}  // namespace frahm::studies
