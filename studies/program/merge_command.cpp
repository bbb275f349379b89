#include "studies/program/merge_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <iostream>
#include <optional>

#include "engine/fingerprint.hpp"
#include "engine/io_error.hpp"
#include "engine/output_lock.hpp"
#include "engine/stop_request.hpp"
#include "engine/tile_index.hpp"
#include "studies/map/assemble.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/map_table.hpp"
#include "studies/program/run_tuning.hpp"
#include "studies/program/study_note.hpp"
#include "studies/provenance/fingerprint.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/tuning/assemble_tuning.hpp"
#include "studies/tuning/tuning_plan.hpp"

namespace frahm::studies {
namespace {

// The study named in the first log that has one.
engine::LogHeader study_of(const std::vector<std::filesystem::path>& logs,
                           const std::filesystem::path& output) {
  for (const auto& log : logs) {
    if (!std::filesystem::exists(log)) throw engine::IoError(log, "there is no such shard log");
  }
  for (const auto& log : logs) {
    if (const auto study = engine::study_of_log(log)) return *study;
  }
  throw engine::IoError(output, "there is no shard log to merge");
}

// The files next to which the note of the study may lie: the output, and those the logs were written for
// (<output>.<writer>.frahm-log).
std::vector<std::filesystem::path> places_of_note(const MergeOptions& options,
                                                  const std::vector<std::filesystem::path>& logs) {
  std::vector<std::filesystem::path> places{options.output};
  for (const auto& log : logs) places.push_back(log.parent_path() / log.stem().stem());
  return places;
}

RunFacts facts_of(const MergeOptions& options) {
  return {
      .command = fmt::format("frahm merge {}", options.output.string()), .threads = 1, .started = utc_now()};
}

AssemblyOptions assembly_of(const MergeOptions& options, const std::vector<std::filesystem::path>& logs,
                            const engine::StopRequest& stop) {
  return {.output = options.output,
          .logs = logs,
          .partial = options.partial,
          .threads = options.threads,
          .progress = options.progress,
          .stop_asked = [&stop] { return stop.asked(); }};
}

int tell_stopped(const MergeOptions& options, const engine::StopRequest& stop) {
  fmt::print(std::cerr, "{}; the shard logs are kept and {} is unchanged\n", stop.reason(),
             options.output.string());
  return exit_code::stopped;
}

void remove_notes(const MergeOptions& options, const std::vector<std::filesystem::path>& logs) {
  for (const auto& place : places_of_note(options, logs)) remove_study_notes(place);
}

// A result from which missing points are still to be taken must not be replaced by a partial one.
void refuse_loss_of_source(const MergeOptions& options, const StudyPlan& plan) {
  if (!options.partial || !plan.grown_from || !std::filesystem::exists(options.output)) return;
  const results::MapReader there(options.output);
  if (identity_of(there.texts("provenance")) != plan.grown_from->identity) return;
  throw engine::IoError(options.output,
                        fmt::format("the missing points come from it, and a partial file would replace it; "
                                    "use frahm merge ANOTHER.h5 {}.*.frahm-log --partial",
                                    options.output.string()));
}

// A result of another study is not replaced, unless the map grows from it and replaces it.
void refuse_another_result(const MergeOptions& options, const StudyPlan& plan) {
  if (!std::filesystem::exists(options.output)) return;
  const results::MapReader there(options.output);
  const engine::Fingerprint kept = fingerprint_of(there);
  if (kept == plan.fingerprint) return;
  if (plan.grown_from && identity_of(there.texts("provenance")) == plan.grown_from->identity) return;
  throw engine::ResumeRefused(options.output, kept, plan.fingerprint,
                              "it is not replaced: name another file to make, or remove this one first");
}

int merge_map(const MergeOptions& options, const std::vector<std::filesystem::path>& logs,
              const engine::LogHeader& header, NotedStudy noted, const engine::OutputLock& lock,
              std::ostream& out) {
  MapPlan plan = plan_map(std::move(noted.study), noted.set);
  plan.grown_from = noted.grown_from;
  check_note_gives(plan, noted, header);
  refuse_loss_of_source(options, plan);
  refuse_another_result(options, plan);
  const engine::StopRequest stop(std::nullopt);
  const Assembly assembly = assemble(plan, facts_of(options), assembly_of(options, logs, stop), lock);
  if (!assembly.finished) return tell_stopped(options, stop);
  if (assembly.missing_tiles == 0) {
    remove_notes(options, logs);
  } else {
    fmt::print(out, "{} of {} tiles are missing: their points are not computed; the logs are kept{}\n",
               assembly.missing_tiles, assembly.tiles, assembly.missing_tasks);
  }
  return print_map_table(plan, plan.study.source.name, options.output, std::nullopt, out);
}

int merge_tuning(const MergeOptions& options, const std::vector<std::filesystem::path>& logs,
                 const engine::LogHeader& header, NotedStudy noted, const engine::OutputLock& lock,
                 std::ostream& out) {
  const StudyPlan plan = plan_tuning(std::move(noted.study), noted.set);
  check_note_gives(plan, noted, header);
  refuse_another_result(options, plan);
  const engine::StopRequest stop(std::nullopt);
  const auto result = assemble_tuning(plan, facts_of(options), assembly_of(options, logs, stop), lock);
  if (!result) return tell_stopped(options, stop);
  const std::uint64_t missing = plan.tiles - result->starts.size();
  if (missing == 0) {
    remove_notes(options, logs);
  } else {
    fmt::print(out, "{} of {} starts are missing; the logs are kept\n", missing, plan.tiles);
  }
  return tell_tuning(plan, *result, options.output, out);
}

// Whether an earlier merge or run has made the file already: a whole result of the same study as the logs
// that are still there. Such logs, left by a process killed while removing them, are removed.
bool is_merged(const MergeOptions& options, std::vector<std::filesystem::path> logs, std::ostream& out) {
  check_result_place(options.output, {});
  if (!std::filesystem::exists(options.output)) return false;
  const results::MapReader there(options.output);
  if (is_part(there)) return false;
  std::erase_if(logs, [](const auto& log) { return !std::filesystem::exists(log); });
  for (const auto& log : logs) {
    const auto study = engine::study_of_log(log);
    if (study && study->fingerprint != fingerprint_of(there)) return false;
  }
  refuse_damage(there, logs.empty() ? "frahm run --fresh computes it again"
                                    : "remove it, and merge makes it again from the shard logs");
  engine::remove_logs(logs);
  remove_notes(options, logs);
  fmt::print(out, "{} is finished already; nothing is left to merge\n", options.output.string());
  return true;
}

}  // namespace

int merge_command(const MergeOptions& options, std::ostream& out) {
  engine::let_failed_writes_return();
  refuse_folder(options.output);
  refuse_study(options.output);
  require_folder_of(options.output);
  const engine::OutputLock lock(options.output);
  const auto logs = options.logs.empty() ? engine::find_logs(options.output) : options.logs;
  if (is_merged(options, logs, out)) return exit_code::done;
  const engine::LogHeader header = study_of(logs, options.output);
  NotedStudy noted = study_from_note(places_of_note(options, logs), header);
  try {
    return noted.study.kind() == StudyKind::tune
               ? merge_tuning(options, logs, header, std::move(noted), lock, out)
               : merge_map(options, logs, header, std::move(noted), lock, out);
  } catch (const engine::ResumeRefused& refused) {
    if (!refused.advice().empty()) throw;
    throw engine::ResumeRefused(refused, fmt::format("leave {} out, or remove it", refused.log().string()));
  }
}

}  // namespace frahm::studies
