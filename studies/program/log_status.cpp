#include "studies/program/log_status.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <map>
#include <memory>
#include <set>
#include <utility>

#include "engine/io_error.hpp"
#include "engine/survey.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/program/study_note.hpp"
#include "studies/provenance/array_tasks.hpp"
#include "studies/tuning/tuning_plan.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t most_logs_listed = 10;  // listed by name; the others are counted

// The job of some logs, and its plan.
struct LoggedJob {
  std::unique_ptr<const MapPlan> map;
  std::unique_ptr<const StudyPlan> tuning;
  engine::Job job;
  std::string unit;  // the unit of the counts: points, starts or tiles
};

LoggedJob job_of_note(const std::filesystem::path& output, const engine::LogHeader& study) {
  NotedStudy noted = study_from_note({output}, study);
  LoggedJob known;
  if (noted.study.kind() == StudyKind::tune) {
    known.tuning = std::make_unique<const StudyPlan>(plan_tuning(std::move(noted.study), noted.set));
    known.job = job_of_tuning(*known.tuning);
    known.unit = "starts";
    check_note_gives(*known.tuning, noted, study);
  } else {
    MapPlan plan = plan_map(std::move(noted.study), noted.set);
    plan.grown_from = noted.grown_from;
    known.map = std::make_unique<const MapPlan>(std::move(plan));
    known.job = job_of(*known.map);
    known.unit = "points";
    check_note_gives(*known.map, noted, study);
  }
  return known;
}

LoggedJob job_of_tiles(const std::filesystem::path& log, const engine::LogHeader& study) {
  constexpr std::uint64_t most_tiles = 100'000'000;  // to index them takes 16 bytes each
  if (study.tiles == 0 || study.tiles > most_tiles)
    throw engine::IoError(log, fmt::format("the header of this shard log gives {} tiles: must be 1 to {}",
                                           study.tiles, most_tiles));
  LoggedJob known;
  known.job = {.tiles = study.tiles,
               .fingerprint = study.fingerprint,
               .make_kernel = {},
               .points = [](std::uint64_t) { return std::uint64_t{1}; },
               .failed = {}};
  known.unit = "tiles";
  return known;
}

LoggedJob job_of_logs(const std::filesystem::path& output, const std::filesystem::path& log,
                      const engine::LogHeader& study, std::ostream& out) {
  std::string reason;
  try {
    return job_of_note(output, study);
  } catch (const engine::IoError& error) {
    reason = error.what();
  } catch (const StudyError& error) {
    reason = error.what();
  }
  fmt::print(out, "{:<22} unknown: {}\n", "points", reason);
  return job_of_tiles(log, study);
}

void print_done(const engine::Survey& survey, const LoggedJob& known, std::ostream& out) {
  const auto& points = survey.points;
  fmt::print(out, "{:<22} {} of {} done ({:.1f} %), ", known.unit, points.done, points.points,
             100.0 * static_cast<double>(points.done) / static_cast<double>(points.points));
  if (known.job.failed) fmt::print(out, "{} of them without a response, ", points.failed);
  fmt::print(out, "{} missing\n", points.points - points.done);
  if (known.unit != "points") return;
  fmt::print(out, "{:<22} {} of {} done, {} missing\n", "tiles", known.job.tiles - survey.missing.size(),
             known.job.tiles, survey.missing.size());
}

// For each number of shards, the shards being computed at this moment.
std::map<std::uint64_t, std::set<std::uint64_t>> shards_at_work(const engine::Survey& survey) {
  std::map<std::uint64_t, std::set<std::uint64_t>> shards;
  for (const engine::WriterState& writer : survey.writers) {
    if (writer.at_work && writer.shard) shards[writer.shard->count].insert(writer.shard->index);
  }
  return shards;
}

void print_work(const engine::Survey& survey, const std::string& unit, std::ostream& out) {
  const auto at_work = shards_at_work(survey);
  if (at_work.empty()) fmt::print(out, "{:<22} nobody\n", "at work");
  for (const auto& [count, shards] : at_work) {
    const std::vector<std::uint64_t> numbers(shards.begin(), shards.end());
    fmt::print(out, "{:<22} {}\n", "at work",
               count == 1
                   ? "one run of everything"
                   : fmt::format("{} of {} array tasks: {}", numbers.size(), count, array_list(numbers)));
  }
  if (at_work.empty()) return;
  fmt::print(out, "{:<22} {}\n", "rate",
             survey.rate ? fmt::format("{:.3g} {}/s", *survey.rate, unit) : "unknown");
  fmt::print(out, "{:<22} {}\n", "time left",
             survey.seconds_left ? "about " + engine::readable_time(*survey.seconds_left) : "unknown");
}

// The tasks to submit again: for each submitted array its tasks with tiles missing, and among them those that
// are not being computed. Any one of the arrays completes the work.
void print_missing_tasks(const engine::Survey& survey, const std::vector<std::filesystem::path>& logs,
                         std::ostream& out) {
  if (survey.missing.empty()) return;
  const auto at_work = shards_at_work(survey);
  const std::vector<TaskArray> arrays = task_arrays(logs, survey.missing);
  for (const TaskArray& array : arrays) {
    fmt::print(out, "{:<22} {} of {}: --array={}\n", "missing tasks", array.missing.size(), array.tasks,
               array_list(array.missing));
    const auto busy = at_work.find(array.tasks);
    if (busy == at_work.end()) continue;
    std::vector<std::uint64_t> idle = array.missing;
    std::erase_if(idle, [&](std::uint64_t task) { return busy->second.contains(task); });
    fmt::print(out, "{:<22} {}\n", "of these not at work",
               idle.empty() ? "none" : "--array=" + array_list(idle));
  }
  if (arrays.size() > 1) fmt::print(out, "{:<22} each of these arrays alone completes the rest\n", "");
}

}  // namespace

void print_log_status(const std::filesystem::path& output, const std::vector<std::filesystem::path>& logs,
                      const engine::LogHeader& study, std::ostream& out) {
  const LoggedJob known = job_of_logs(output, logs.front(), study, out);
  const engine::Survey survey = engine::survey(known.job, logs, std::chrono::system_clock::now());
  print_done(survey, known, out);
  print_work(survey, known.unit, out);
  print_missing_tasks(survey, logs, out);
  if (survey.missing.empty())
    fmt::print(out, "{:<22} frahm merge {}\n", "everything is computed", output.string());
  fmt::print(out, "{:<22} {}\n{:<22} {}\n", "fingerprint_physics", study.fingerprint.physics,
             "fingerprint_grid", study.fingerprint.grid);
  if (survey.writers.size() > most_logs_listed) {
    fmt::print(out, "{:<22} {}\n", "logs", survey.writers.size());
  } else {
    for (const auto& writer : survey.writers) fmt::print(out, "{:<22} {}\n", "log", writer.log.string());
  }
  for (const engine::UnusedBytes& unused : survey.unused) {
    fmt::print(out, "{:<22} {}: {} bytes from byte {} on\n", "unused or being written", unused.log.string(),
               unused.bytes, unused.from);
  }
}

}  // namespace frahm::studies
