#include "studies/program/logged_run.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <chrono>
#include <ctime>
#include <iostream>
#include <optional>
#include <vector>

#include "engine/io_error.hpp"
#include "engine/stop_request.hpp"
#include "engine/tile_index.hpp"
#include "studies/map/earlier_axes.hpp"
#include "studies/page/page_groups.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/growing.hpp"
#include "studies/program/refusal_advice.hpp"
#include "studies/program/study_note.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/study_changes.hpp"

namespace frahm::studies {
namespace {

// Writes the words of the study into its finished result: titles, units and whatever else changes no number.
// Returns what changed.
std::vector<std::string> write_words(const StudyPlan& plan, const LoggedWork& work,
                                     const std::filesystem::path& output) {
  const engine::OutputLock lock(output);
  const results::MapReader finished(output);
  if (fingerprint_of(finished) != plan.fingerprint || is_part(finished)) return {};  // changed meanwhile
  OtherWords other = other_words(finished, output, plan);
  if (other.changes.empty()) return {};
  results::Rewording words = work.words(*other.kept, finished);
  std::vector<results::Text> changed;
  std::erase_if(words.texts, [&](auto& of_group) {
    const bool is_provenance = of_group.first == "provenance";
    if (is_provenance) changed = std::move(of_group.second);
    return is_provenance;
  });
  words.anew = page_groups(plan.study, finished.layout());
  words.texts.emplace_back("provenance", provenance_in_words(finished.texts("provenance"), plan, changed));
  results::reword(output, words);
  return other.changes;
}

// The same, told; a shard of several leaves that to a run of its own.
void mend_words(const StudyPlan& plan, const LoggedWork& work, const results::MapReader& finished,
                const engine::RunOptions& run, std::ostream& out) {
  try {
    if (run.shard.count > 1 || other_words(finished, run.output, plan).changes.empty()) return;
    const std::vector<std::string> changes = write_words(plan, work, run.output);
    if (!changes.empty())
      fmt::print(out, "nothing is computed; these changes are written into {}:\n{}", run.output.string(),
                 lines_of_changes(changes));
  } catch (const StudyError& unreadable) {
    fmt::print(out,
               "note: {} keeps its texts, which differ from those of this study, because its own study can "
               "no longer be read ({})\n",
               run.output.string(), unreadable.what());
  }
}

// The logs of the finished result at `output`, which may have grown from another file than it would now.
std::vector<std::filesystem::path> logs_of(const results::MapReader& finished, const StudyPlan& plan,
                                           const std::filesystem::path& output) {
  const engine::LogHeader own = plan.header_of_logs(provenance_text(finished, grown_from_identity));
  std::vector<std::filesystem::path> logs = engine::find_logs(output);
  std::erase_if(logs, [&](const auto& log) { return engine::study_of_log(log) != own; });
  return logs;
}

void remove_leftovers(const results::MapReader& finished, const StudyPlan& plan,
                      const std::filesystem::path& output) {
  if (!logs_of(finished, plan, output).empty() || std::filesystem::exists(engine::lock_path(output))) {
    const engine::OutputLock lock(output);
    engine::remove_logs(logs_of(finished, plan, output));
  }
  if (engine::find_logs(output).empty()) remove_study_notes(output);
}

// The whole result of this plan that stands at `output`; none where there is none, or a part. Throws
// ResumeRefused where another result stands there.
std::optional<results::MapReader> finished_result(const StudyPlan& plan,
                                                  const std::filesystem::path& output) {
  if (!std::filesystem::exists(output)) return std::nullopt;
  results::MapReader standing(output);
  const engine::Fingerprint kept = fingerprint_of(standing);
  if (kept == plan.fingerprint) return is_part(standing) ? std::nullopt : std::optional(std::move(standing));
  const bool could_grow =
      kept.physics == plan.fingerprint.physics && plan.study.map() && kind_of(standing) == ResultKind::map;
  throw engine::ResumeRefused(
      output, kept, plan.fingerprint,
      refusal_advice(changes_since(standing, output, plan),
                     could_grow
                         ? fmt::format("add --from {} to reuse its points, name another file with -o, or "
                                       "discard what is there with --fresh",
                                       output.string())
                         : ""));
}

// The finished result that leaves nothing to compute, or none; then the logs left by a run that was killed
// before it removed them are removed. from: the result from which a map grows; empty: none. lock: takes the
// lock of the output if there is something to compute, unless the run is one shard of several.
std::optional<results::MapReader> begin(const StudyPlan& plan, const engine::RunOptions& run,
                                        const std::filesystem::path& from,
                                        std::optional<engine::OutputLock>& lock) {
  const auto what_stands = [&] {
    const bool is_replaced = run.fresh || grows_in_place(plan, from, run.output);
    return is_replaced ? std::nullopt : finished_result(plan, run.output);
  };
  if (run.fresh && run.shard.count > 1 && std::filesystem::exists(run.output))
    throw engine::IoError(run.output,
                          "exists already, and one shard with --fresh cannot replace it: remove it first");
  std::optional<results::MapReader> finished = what_stands();
  if (!finished && run.shard.count == 1) {
    lock.emplace(run.output);
    finished = what_stands();
    if (finished) lock.reset();  // another process has finished it while this one waited
  }
  if (!finished) return finished;
  const std::string advice = "--fresh computes it again";
  refuse_damage(*finished, advice);
  if (plan.study.map()) refuse_other_axes(plan.study, finished->layout(), run.output.string(), advice);
  remove_leftovers(*finished, plan, run.output);
  return finished;
}

// Computes the missing tiles of a plan's job, with the note of its study next to the logs.
engine::Summary compute(const StudyPlan& plan, const engine::Job& job, const engine::RunOptions& run) {
  const bool is_new = write_study_note(run.output, plan);
  try {
    engine::Summary summary = engine::run(job, run);
    // Another shard may have found the note and have no log yet.
    if (is_new && summary.points.done == 0 && run.shard.count == 1) remove_study_note(run.output, plan);
    return summary;
  } catch (const engine::ResumeRefused& refused) {
    if (is_new) remove_study_note(run.output, plan);
    throw engine::ResumeRefused(refused, advice_about_logs(refused, plan, run.output));
  } catch (...) {  // without a log nothing will need the note
    if (is_new && !has_log_of(run.output, plan)) remove_study_note(run.output, plan);
    throw;
  }
}

// Notes on stderr the unusable parts of earlier logs.
void tell_unused(const engine::Summary& summary) {
  for (const engine::UnusedBytes& unused : summary.unused) {
    fmt::print(std::cerr,
               "note: {}: {} bytes from byte {} on are not complete tiles and are computed again\n",
               unused.log.string(), unused.bytes, unused.from);
  }
}

// The ends of a run that makes no file: stopped while it computed, or while the file was made; one shard of
// several. They return the exit code.
int tell_stopped(const engine::Summary& summary, const std::filesystem::path& output) {
  if (summary.points.done == 0) {
    fmt::print(std::cerr, "{}: nothing is computed yet; the same command starts again\n", summary.reason);
    return exit_code::stopped;
  }
  const double percent =
      100.0 * static_cast<double>(summary.points.done) / static_cast<double>(summary.points.points);
  fmt::print(std::cerr, "{}: {:.1f} % is done and kept next to {}; the same command resumes from there\n",
             summary.reason, percent, output.string());
  return exit_code::stopped;
}

// seconds: that the making of the file had; it begins again.
int tell_unwritten(const engine::StopRequest& stop, const std::filesystem::path& output, double seconds) {
  fmt::print(std::cerr,
             "{}: everything is computed and kept next to {}; the same command makes the file, which takes "
             "more than the {:.1f} s that were left\n",
             stop.reason(), output.string(), seconds);
  return exit_code::stopped;
}

int tell_shard(const engine::RunOptions& run, const engine::Summary& summary, std::ostream& out) {
  fmt::print(out, "shard {}/{}: {} tiles are kept next to {}\nwhen all shards are done: frahm merge {}\n",
             run.shard.index, run.shard.count, summary.tiles, run.output.string(), run.output.string());
  if (summary.points.failed == 0) return exit_code::done;
  fmt::print(std::cerr, "{} points have no response; the merged file lists them\n", summary.points.failed);
  return exit_code::some_failed;
}

}  // namespace

std::string team_text(int threads, int ranks) {
  std::string text = fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
  if (ranks > 1) text += fmt::format(" of {} ranks", ranks);
  return text;
}

int run_in_logs(const RunCommandOptions& options, const engine::RunOptions& run, const StudyPlan& plan,
                const LoggedWork& work, std::ostream& out) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const std::clock_t cpu_start = std::clock();
  RunFacts facts{.command = options.command, .threads = 0, .started = utc_now()};
  check_result_place(run.output, options.study, run.fresh);
  std::optional<engine::OutputLock> lock;
  if (const auto finished = begin(plan, run, options.from, lock)) {
    fmt::print(out, "everything is computed already; --fresh computes it again\n");
    mend_words(plan, work, *finished, run, out);
    return work.tell_what_stands();
  }
  const engine::Summary summary = compute(plan, work.job(), run);
  tell_unused(summary);
  if (summary.outcome == engine::Outcome::stopped) return tell_stopped(summary, run.output);
  if (run.shard.count > 1) return tell_shard(run, summary, out);

  facts.threads = summary.threads;
  facts.ranks = summary.ranks;
  const engine::StopRequest stop(run.time_budget, Clock::now() - run.begun, run.called_off);
  const AssemblyOptions assembly{.output = run.output,
                                 .logs = engine::find_logs(run.output),
                                 .threads = summary.threads_here,
                                 .progress = run.progress,
                                 .stop_asked = [&] { return stop.asked(); }};
  check_result_place(run.output, options.study, run.fresh);  // again: it may have changed
  const Clock::time_point computed = Clock::now();
  if (!work.assemble(facts, assembly, *lock))
    return tell_unwritten(stop, run.output, std::chrono::duration<double>(Clock::now() - computed).count());
  remove_study_notes(run.output);
  return work.tell_made({.points = summary.points.done - summary.points.resumed - summary.points.reused,
                         .reused = summary.points.reused,
                         .seconds = std::chrono::duration<double>(Clock::now() - start).count(),
                         .cpu_seconds = static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC +
                                        summary.cpu_seconds_elsewhere,
                         .threads = summary.threads,
                         .ranks = summary.ranks});
}

}  // namespace frahm::studies
