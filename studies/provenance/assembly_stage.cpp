#include "studies/provenance/assembly_stage.hpp"

#include <fmt/ostream.h>

#include <iostream>

#include "engine/tile_index.hpp"

namespace frahm::studies {
namespace {

// The work of the stage; a piece counts as done when it has had its turn.
engine::PieceWork counted(const AssemblyStage& stage, StageProgress& progress) {
  return [work = stage.make_work(), &stage, &progress](std::uint64_t piece) {
    return [turn = work(piece), piece, &stage, &progress] {
      turn();
      progress.add(stage.points_of(piece));
    };
  };
}

}  // namespace

StageProgress::StageProgress(const std::string& name, std::uint64_t points, engine::ProgressStyle style)
    : points_(points),
      progress_(engine::progress_form(style), std::cerr, engine::Progress::Clock::now, name),
      watch_(std::chrono::milliseconds(100), [this] { look(); }) {}

StageProgress::~StageProgress() {
  watch_.end();
  if (shown_) progress_.finish(tally());
}

void StageProgress::look() {
  constexpr std::chrono::seconds silence(1);
  if (std::chrono::steady_clock::now() - start_ < silence) return;
  progress_.update(tally());
  shown_ = true;
}

void carry_out(const AssemblyStage& stage, const AssemblyOptions& options) {
  StageProgress progress(stage.name, stage.points, options.progress);
  const bool all = engine::make_in_order(
      options.threads, stage.pieces, [&] { return counted(stage, progress); }, options.stop_asked);
  if (!all) throw AssemblyStopped{};
}

void remove_used_logs(const AssemblyOptions& options) {
  for (const std::string& in_use : engine::remove_free_logs(options.logs))
    fmt::print(std::cerr, "note: {} is made from all logs; one log remains: {}\n", options.output.string(),
               in_use);
}

}  // namespace frahm::studies
