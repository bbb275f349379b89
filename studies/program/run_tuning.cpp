#include "studies/program/run_tuning.hpp"

#include <fmt/ostream.h>

#include <chrono>
#include <ctime>
#include <iostream>
#include <optional>

#include "engine/tile_index.hpp"
#include "results/map_reader.hpp"
#include "studies/map/finished_file.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/logged_run.hpp"
#include "studies/program/status_command.hpp"
#include "studies/program/study_note.hpp"
#include "studies/tuning/assemble_tuning.hpp"
#include "studies/tuning/outcome_words.hpp"
#include "studies/tuning/tuning_plan.hpp"
#include "studies/tuning/tuning_record.hpp"
#include "studies/tuning/tuning_table.hpp"

namespace frahm::studies {
namespace {

using Clock = std::chrono::steady_clock;

// The exit code of a tuning that was finished before, from the outcomes in its file.
int code_of_file(const std::filesystem::path& file) {
  const results::MapReader result(file);
  const bool is_front = result.has_group(front_group);
  for (const results::Column& column : result.columns(is_front ? front_group : optimum_group)) {
    if (column.variable.name != "outcome") continue;
    for (const double outcome : column.values) {
      if (outcome != 1.0 + static_cast<int>(tuning::Outcome::converged)) return exit_code::not_converged;
    }
  }
  return exit_code::done;
}

}  // namespace

int tell_tuning(const StudyPlan& plan, const TuningResult& result, const std::filesystem::path& file,
                std::ostream& out) {
  print_tuning(plan.study, result, out);
  fmt::print(out, "{:<22}{}\n", "file", file.string());
  int code = exit_code::done;
  for (std::size_t i = 0; i < result.limits(); ++i) {
    const tuning::Optimum& optimum = result.optimum(i);
    if (optimum.outcome == tuning::Outcome::converged) continue;
    code = exit_code::not_converged;
    fmt::print(std::cerr, "{}: {}; the best design so far is in the file\n",
               outcome_words().at(static_cast<std::size_t>(optimum.outcome)), optimum.reason);
  }
  return code;
}

int run_tuning(const RunCommandOptions& options, Study study, std::ostream& out) {
  const Clock::time_point start = Clock::now();
  const std::clock_t cpu_start = std::clock();
  RunRecord record{.command = options.command, .threads = 0, .started = utc_now()};
  engine::RunOptions run = options.run;
  if (run.output.empty()) run.output = default_output(options.study);
  const StudyPlan plan = plan_tuning(std::move(study), options.set);

  check_result_place(run.output, options.study);
  std::optional<engine::OutputLock> lock;
  if (!begin(plan, run, {}, lock)) {
    fmt::print(out, "everything is computed already; --fresh computes it anew\n");
    status_command(run.output, out);
    return code_of_file(run.output);
  }
  const engine::Summary summary = compute(plan, job_of_tuning(plan), run);
  tell_unused(summary);
  if (summary.outcome == engine::Outcome::stopped) return tell_stopped(summary, run.output);
  if (run.shard.count > 1) return tell_shard(run, summary, out);

  check_result_place(run.output, options.study);  // as it was before, still
  record.threads = summary.threads;
  record.ranks = summary.ranks;
  const engine::StopRequest stop(run.time_budget, engine::StopRequest::Seconds(summary.seconds));
  const auto stop_asked = [&] { return stop.asked(); };
  const std::optional<TuningResult> result = assemble_tuning(
      plan, record, {.output = run.output, .logs = engine::find_logs(run.output), .stop_asked = stop_asked},
      *lock);
  if (!result) return tell_unwritten(stop, run.output);
  remove_study_notes(run.output);
  const int code = tell_tuning(plan, *result, run.output, out);
  const double cpu_seconds =
      static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC + summary.cpu_seconds_elsewhere;
  fmt::print(out, "{:<22}{:.2f} s wall, {:.2f} s CPU on {}\n", "time",
             std::chrono::duration<double>(Clock::now() - start).count(), cpu_seconds,
             team_text(summary.threads, summary.ranks));
  return code;
}

}  // namespace frahm::studies
