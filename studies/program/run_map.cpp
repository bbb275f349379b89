#include "studies/program/run_map.hpp"

#include <fmt/ostream.h>

#include <chrono>
#include <ctime>
#include <optional>

#include "engine/tile_index.hpp"
#include "studies/map/assemble.hpp"
#include "studies/map/finished_file.hpp"
#include "studies/map/known_points.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/growing.hpp"
#include "studies/program/logged_run.hpp"
#include "studies/program/map_table.hpp"
#include "studies/program/study_note.hpp"

namespace frahm::studies {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

int run_map(const RunCommandOptions& options, Study study, std::ostream& out) {
  const Clock::time_point start = Clock::now();
  const std::clock_t cpu_start = std::clock();
  RunRecord record{.command = options.command, .threads = 0, .started = utc_now()};
  engine::RunOptions run = options.run;
  if (run.output.empty()) run.output = default_output(options.study);
  MapPlan plan = plan_map(std::move(study), options.set);

  check_result_place(run.output, options.study);
  std::optional<engine::OutputLock> lock;
  if (!begin(plan, run, options.from, lock)) {
    fmt::print(out, "everything is computed already; --fresh computes it anew\n");
    return print_map_table(plan, options.study, run.output, std::nullopt, out);
  }
  std::optional<KnownPoints> earlier;
  if (!options.from.empty()) plan.grown_from = earlier.emplace(plan, options.from).source();
  if (earlier) refuse_loss(plan, *earlier, options.from, run.output);
  const engine::Summary summary = compute(plan, job_of(plan, earlier ? &*earlier : nullptr), run);
  tell_unused(summary);
  if (summary.outcome == engine::Outcome::stopped) return tell_stopped(summary, run.output);
  if (run.shard.count > 1) return tell_shard(run, summary, out);

  earlier.reset();                                // the new file may take its place
  check_result_place(run.output, options.study);  // as it was before, still
  record.threads = summary.threads;
  record.ranks = summary.ranks;
  const engine::StopRequest stop(run.time_budget, engine::StopRequest::Seconds(summary.seconds));
  const Assembly assembly = assemble(plan, record,
                                     {.output = run.output,
                                      .logs = engine::find_logs(run.output),
                                      .threads = summary.threads_here,
                                      .progress = run.progress,
                                      .stop_asked = [&] { return stop.asked(); }},
                                     *lock);
  if (!assembly.finished) return tell_unwritten(stop, run.output);
  remove_study_notes(run.output);
  const Effort effort{.points = summary.points.done - summary.points.resumed - summary.points.reused,
                      .reused = summary.points.reused,
                      .seconds = std::chrono::duration<double>(Clock::now() - start).count(),
                      .cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC +
                                     summary.cpu_seconds_elsewhere,
                      .threads = summary.threads,
                      .ranks = summary.ranks};
  return print_map_table(plan, options.study, run.output, effort, out);
}

}  // namespace frahm::studies
