#include "studies/program/status_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

#include "engine/io_error.hpp"
#include "engine/tile_index.hpp"
#include "studies/map/map_summary.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/log_status.hpp"
#include "studies/provenance/fingerprint.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/provenance_checksum.hpp"
#include "studies/reading/quantities/unit_words.hpp"

namespace frahm::studies {
namespace {

std::string number_text(const results::Column& column) {
  const double value = column.values.front();
  if (std::isnan(value)) return "none";
  for (const results::Flag& flag : column.variable.flags) {
    if (flag.value == value) return flag.meaning;
  }
  return with_unit(fmt::format("{:.10g}", value), column.variable.unit);
}

// A file without a map holds one motion or optimum: its single numbers, and how many rows its other columns
// have.
void print_group(const results::MapReader& map, const std::string& group, std::ostream& out) {
  std::vector<std::string> printed;
  for (const results::Column& column : map.columns(group)) {
    if (column.dimension.empty()) {
      fmt::print(out, "{:<22} {}\n", column.variable.name, number_text(column));
    } else if (std::find(printed.begin(), printed.end(), column.dimension) == printed.end()) {
      printed.push_back(column.dimension);
      fmt::print(out, "{:<22} {} rows\n", column.dimension, column.values.size());
    }
  }
}

void print_groups(const results::MapReader& map, std::ostream& out) {
  const std::string group = own_group(map);
  if (group.empty()) return;
  switch (kind_of(map)) {
    case ResultKind::map:
    case ResultKind::branch:
      return;
    case ResultKind::motion:
      fmt::print(out, "{:<22} {}\n", "motion", group);
      break;
    case ResultKind::tuning:
    case ResultKind::identification:
      for (const auto& [name, text] : map.texts(group)) fmt::print(out, "{:<22} {}\n", name, text);
      break;
  }
  print_group(map, group, out);
}

void print_file(const std::filesystem::path& file, std::ostream& out) {
  const results::MapReader map(file);
  const results::MapLayout& layout = map.layout();
  const std::uint64_t points = points_of(layout);
  fmt::print(out, "{}: {}\n{:<22} {}\n", file.string(), is_part(map) ? "a part of the result" : "finished",
             "title", layout.title);
  for (const results::Axis& axis : layout.axes) {
    fmt::print(out, "{:<22} {}: {} point{}\n", "axis", axis.name, axis.size, axis.size == 1 ? "" : "s");
  }
  if (layout.axes.empty()) {
    print_groups(map, out);
  } else {
    fmt::print(out, "{:<22} {}\n{:<22} {}\n", "points", points, "variables", layout.variables.size());
    print_flags(count_flags(map), points, out);
  }
  if (!map.has_group("provenance")) return;
  refuse_changed_provenance(map);
  for (const auto& [name, text] : map.texts("provenance")) {
    if (name != "study" && name != "failed_points" && name != checksum_text && !text.empty())
      fmt::print(out, "{:<22} {}\n", name, text);
  }
}

// The logs next to a file, by their study: there are several studies only if a run was refused or a log put
// there by hand.
struct FoundLogs {
  std::vector<std::pair<engine::LogHeader, std::vector<std::filesystem::path>>> studies;
  std::vector<std::string> unreadable;  // the error of each log that cannot be read
  std::vector<std::string> cut_off;     // logs that end in their header, and hold nothing
};

FoundLogs logs_beside(const std::filesystem::path& file) {
  FoundLogs found;
  for (const auto& log : engine::find_logs(file)) {
    try {
      const auto study = engine::study_of_log(log);
      if (!study) {
        found.cut_off.push_back(log.string());
        continue;
      }
      auto known = std::find_if(found.studies.begin(), found.studies.end(),
                                [&](const auto& some) { return some.first == *study; });
      if (known == found.studies.end()) known = found.studies.insert(known, {*study, {}});
      known->second.push_back(log);
    } catch (const engine::IoError& error) {
      found.unreadable.push_back(error.what());
    }
  }
  return found;
}

// Whether a result is a part that was made of these logs.
bool is_part_of(const std::filesystem::path& file, const engine::LogHeader& logs) {
  const results::MapReader part(file);
  if (!is_part(part)) return false;
  const engine::Fingerprint study = fingerprint_of(part);
  const std::string source = provenance_text(part, grown_from_identity);
  return logs.fingerprint == (source.empty() ? study : grown_fingerprint(study, source));
}

std::string state_of_logs(const std::filesystem::path& file, const engine::LogHeader& logs) {
  if (!std::filesystem::exists(file)) return "unfinished";
  return is_part_of(file, logs) ? "a part, made from the logs next to it; its run continues"
                                : "a newer run is in progress or was stopped";
}

}  // namespace

int status_command(const std::filesystem::path& file, std::ostream& out) {
  refuse_folder(file);
  const bool is_there = std::filesystem::exists(file);
  if (is_there) refuse_study(file);
  const FoundLogs found = logs_beside(file);
  if (!is_there && found.studies.empty() && found.unreadable.empty() && found.cut_off.empty())
    throw engine::IoError(file, "there is no such file, and no shard log next to it");
  for (const auto& [study, logs] : found.studies) {
    fmt::print(out, "{}: {}\n", file.string(), state_of_logs(file, study));
    print_log_status(file, logs, study, out);
  }
  for (const std::string& problem : found.unreadable)
    fmt::print(out, "{:<22} {}\n", "unreadable log", problem);
  for (const std::string& log : found.cut_off)
    fmt::print(out, "{:<22} {}: it ends in its header, so nothing is lost; a run starts it again\n",
               "empty log", log);
  if (is_there) print_file(file, out);
  return found.unreadable.empty() ? exit_code::done : exit_code::input_output;
}

}  // namespace frahm::studies
