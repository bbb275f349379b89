#include "studies/program/merge_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

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

// The study of the first log that says one.
engine::LogHeader study_of(const std::vector<std::filesystem::path>& logs,
                           const std::filesystem::path& output) {
  for (const auto& log : logs) {
    if (!std::filesystem::exists(log)) throw engine::IoError(log, "there is no such shard log");
    if (const auto study = engine::study_of_log(log)) return *study;
  }
  throw engine::IoError(output, "there is no shard log to merge");
}

// The files beside which the note of the study may lie: the output, and those the logs were written for
// (<output>.<writer>.frahm-log).
std::vector<std::filesystem::path> places_of_note(const MergeOptions& options,
                                                  const std::vector<std::filesystem::path>& logs) {
  std::vector<std::filesystem::path> places{options.output};
  for (const auto& log : logs) places.push_back(log.parent_path() / log.stem().stem());
  return places;
}

}  // namespace

int merge_command(const MergeOptions& options, std::ostream& out) {
  const auto logs = options.logs.empty() ? engine::find_logs(options.output) : options.logs;
  const engine::LogHeader header = study_of(logs, options.output);
  NotedStudy noted = study_from_note(places_of_note(options, logs), header);
  const MapPlan plan = plan_map(std::move(noted.study), noted.set);
  check_note_gives(plan, noted, header);
  const RunRecord record{
      .command = fmt::format("frahm merge {}", options.output.string()), .threads = 1, .started = utc_now()};
  check_result_place(options.output, {});
  const engine::StopSignals signals;
  const Assembly assembly = assemble(
      plan, record, {.output = options.output, .logs = logs, .partial = options.partial, .stop_asked = [&] {
                       return signals.received() != 0;
                     }});
  if (!assembly.finished) {
    fmt::print(std::cerr, "stopped; the shard logs are kept and {} is as it was\n", options.output.string());
    return exit_code::stopped;
  }
  if (assembly.missing_tiles == 0) {
    for (const auto& place : places_of_note(options, logs)) remove_study_notes(place);
  } else {
    fmt::print(out, "{} of {} tiles are missing: their points are not computed; the logs are kept\n",
               assembly.missing_tiles, assembly.tiles);
  }
  return print_map_table(plan, plan.study.source.name, options.output, std::nullopt, out);
}

}  // namespace frahm::studies
