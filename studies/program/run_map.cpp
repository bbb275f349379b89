#include "studies/program/run_map.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <chrono>
#include <ctime>
#include <iostream>
#include <optional>

#include "engine/io_error.hpp"
#include "engine/stop_signals.hpp"
#include "engine/tile_index.hpp"
#include "studies/map/assemble.hpp"
#include "studies/map/finished_file.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/map_table.hpp"
#include "studies/program/study_note.hpp"

namespace frahm::studies {
namespace {

using Clock = std::chrono::steady_clock;

// What an earlier run that was killed between writing the file and removing its logs has left.
void remove_leftovers(const MapPlan& plan, const std::filesystem::path& output) {
  std::vector<std::filesystem::path> logs = engine::find_logs(output);
  std::erase_if(logs, [&](const auto& log) { return engine::study_of_log(log) != plan.log_header(); });
  engine::remove_logs(logs);
  engine::remove_assembly_lock(output);
  if (engine::find_logs(output).empty()) remove_study_notes(output);
}

// Whether the file is there already, and is that of this study.
bool is_finished(const MapPlan& plan, const std::filesystem::path& output) {
  const auto kept = fingerprint_of_file(output);
  if (!kept) return false;
  if (*kept == plan.fingerprint) return true;
  throw engine::ResumeRefused(output, {*kept, plan.tiles}, plan.log_header());
}

engine::Summary compute(const MapPlan& plan, const engine::RunOptions& run) {
  write_study_note(run.output, plan);
  try {
    return engine::run(job_of(plan), run);
  } catch (const engine::ResumeRefused&) {
    remove_study_note(run.output, plan.fingerprint);
    throw;
  }
}

void tell_unused(const engine::Summary& summary) {
  for (const engine::UnusedBytes& unused : summary.unused) {
    fmt::print(std::cerr, "note: {}: {} bytes from byte {} on are no whole tile and are computed again\n",
               unused.log.string(), unused.bytes, unused.from);
  }
}

int tell_stopped(const engine::Summary& summary, const std::filesystem::path& output) {
  const double percent =
      100.0 * static_cast<double>(summary.points.done) / static_cast<double>(summary.points.points);
  fmt::print(std::cerr, "{}: {:.1f} % is done and kept beside {}; the same command goes on from there\n",
             summary.reason, percent, output.string());
  return exit_code::stopped;
}

int tell_shard(const engine::RunOptions& run, const engine::Summary& summary, std::ostream& out) {
  fmt::print(out, "shard {}/{}: {} tiles are kept beside {}\nwhen all shards are done: frahm merge {}\n",
             run.shard.index, run.shard.count, summary.tiles, run.output.string(), run.output.string());
  if (summary.points.failed == 0) return exit_code::done;
  fmt::print(std::cerr, "{} points failed; the merged file lists them\n", summary.points.failed);
  return exit_code::some_failed;
}

}  // namespace

int run_map(const RunCommandOptions& options, StudyFile study, std::ostream& out) {
  const Clock::time_point start = Clock::now();
  const std::clock_t cpu_start = std::clock();
  RunRecord record{.command = options.command, .threads = 0, .started = utc_now()};
  engine::RunOptions run = options.run;
  if (run.output.empty()) run.output = default_output(options.study);
  const MapPlan plan = plan_map(std::move(study), options.set);

  check_result_place(run.output, options.study);
  if (!run.fresh && is_finished(plan, run.output)) {
    remove_leftovers(plan, run.output);
    fmt::print(out, "everything is computed already; --fresh computes it anew\n");
    return print_map_table(plan, options.study, run.output, std::nullopt, out);
  }
  const engine::Summary summary = compute(plan, run);
  tell_unused(summary);
  if (summary.outcome == engine::Outcome::stopped) return tell_stopped(summary, run.output);
  if (run.shard.count > 1) return tell_shard(run, summary, out);

  record.threads = summary.threads;
  const engine::StopSignals signals;
  const Assembly assembly =
      assemble(plan, record, {.output = run.output, .logs = engine::find_logs(run.output), .stop_asked = [&] {
                                return signals.received() != 0;
                              }});
  if (!assembly.finished) return tell_stopped(summary, run.output);
  remove_study_notes(run.output);
  const Effort effort{.points = summary.points.done - summary.points.resumed,
                      .seconds = std::chrono::duration<double>(Clock::now() - start).count(),
                      .cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC,
                      .threads = summary.threads};
  return print_map_table(plan, options.study, run.output, effort, out);
}

}  // namespace frahm::studies
