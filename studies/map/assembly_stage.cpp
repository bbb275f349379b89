#include "studies/map/assembly_stage.hpp"

#include <atomic>
#include <chrono>
#include <exception>
#include <iostream>
#include <utility>

#include "engine/watch.hpp"

namespace frahm::studies {
namespace {

using Clock = std::chrono::steady_clock;

// The work of the stage; a piece counts as done when it has had its turn.
engine::PieceWork counted(const AssemblyStage& stage, std::atomic<std::uint64_t>& done) {
  return [work = stage.make_work(), &stage, &done](std::uint64_t piece) {
    return [turn = work(piece), piece, &stage, &done] {
      turn();
      done += stage.points_of(piece);
    };
  };
}

}  // namespace

void carry_out(const AssemblyStage& stage, const AssemblyOptions& options) {
  constexpr std::chrono::seconds silence(1);
  std::atomic<std::uint64_t> done = 0;
  const auto tally = [&] { return engine::Tally{.points = stage.points, .done = done}; };
  engine::Progress progress(engine::progress_form(options.progress), std::cerr, Clock::now, stage.name);
  bool shown = false;
  engine::Watch watch(std::chrono::milliseconds(100), [&, start = Clock::now()] {
    if (Clock::now() - start < silence) return;
    progress.update(tally());
    shown = true;
  });
  bool all = false;
  std::exception_ptr error;
  try {
    all = engine::make_in_order(
        options.threads, stage.pieces, [&] { return counted(stage, done); }, options.stop_asked);
  } catch (...) {  // thrown on when the progress has ended its line
    error = std::current_exception();
  }
  watch.end();
  if (shown) progress.finish(tally());
  if (error) std::rethrow_exception(error);
  if (!all) throw AssemblyStopped{};
}

}  // namespace frahm::studies
