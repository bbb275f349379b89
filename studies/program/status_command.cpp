#include "studies/program/status_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <ostream>

#include "engine/io_error.hpp"
#include "engine/tile_index.hpp"
#include "studies/identification/identification_record.hpp"
#include "studies/map/finished_file.hpp"
#include "studies/map/map_summary.hpp"
#include "studies/tuning/tuning_record.hpp"

namespace frahm::studies {
namespace {

std::string number_text(const results::Column& column) {
  const double value = column.values.front();
  for (const results::Flag& flag : column.variable.flags) {
    if (flag.value == value) return flag.meaning;
  }
  const std::string& unit = column.variable.unit;
  return fmt::format("{:.10g}{}", value, unit == "1" ? "" : " " + unit);
}

// A file without a map holds one motion or optimum: its single numbers, and how many rows its other columns
// have.
void print_group(const results::MapReader& map, const std::string& group, std::ostream& out) {
  std::vector<std::string> told;
  for (const results::Column& column : map.columns(group)) {
    if (column.dimension.empty()) {
      fmt::print(out, "{:<22} {}\n", column.variable.name, number_text(column));
    } else if (std::find(told.begin(), told.end(), column.dimension) == told.end()) {
      told.push_back(column.dimension);
      fmt::print(out, "{:<22} {} rows\n", column.dimension, column.values.size());
    }
  }
}

void print_groups(const results::MapReader& map, std::ostream& out) {
  for (const char* group : {"decay", "transient"}) {
    if (!map.has_group(group)) continue;
    fmt::print(out, "{:<22} {}\n", "motion", group);
    print_group(map, group, out);
  }
  if (map.has_group(identification_group)) {
    for (const auto& [name, text] : map.texts(identification_group))
      fmt::print(out, "{:<22} {}\n", name, text);
    print_group(map, identification_group, out);
  }
  if (!map.has_group(optimum_group)) return;
  for (const auto& [name, text] : map.texts(optimum_group)) fmt::print(out, "{:<22} {}\n", name, text);
  print_group(map, optimum_group, out);
}

void print_file(const std::filesystem::path& file, std::ostream& out) {
  const results::MapReader map(file);
  const results::MapLayout& layout = map.layout();
  const std::uint64_t points = points_of(layout);
  fmt::print(out, "{}: {}\n{:<22} {}\n", file.string(),
             is_partial(file) ? "a part of the result" : "finished", "title", layout.title);
  for (const results::Axis& axis : layout.axes) {
    fmt::print(out, "{:<22} {}: {} points\n", "axis", axis.name, axis.size);
  }
  if (layout.axes.empty()) {
    print_groups(map, out);
  } else {
    fmt::print(out, "{:<22} {}\n{:<22} {}\n", "points", points, "variables", layout.variables.size());
    print_flags(count_flags(map), points, out);
  }
  if (!map.has_group("provenance")) return;
  for (const auto& [name, text] : map.texts("provenance")) {
    if (name != "study" && name != "failed_points" && !text.empty())
      fmt::print(out, "{:<22} {}\n", name, text);
  }
}

// The logs of one study: there is more than one only where a run was refused or a log put there by hand.
void print_logs(const std::vector<std::filesystem::path>& logs, const engine::LogHeader& study,
                std::ostream& out) {
  std::vector<std::filesystem::path> own = logs;
  std::erase_if(own, [&](const auto& log) { return engine::study_of_log(log) != study; });
  const engine::TileIndex index = engine::index_tiles(own, study, [](std::uint64_t, auto) {});
  const std::uint64_t missing = engine::missing_tiles(index).size(), done = study.tiles - missing;
  fmt::print(out, "{:<22} {} of {} ({:.1f} %), {} missing\n", "tiles", done, study.tiles,
             100.0 * static_cast<double>(done) / static_cast<double>(study.tiles), missing);
  fmt::print(out, "{:<22} {}\n{:<22} {}\n", "fingerprint_physics", study.fingerprint.physics,
             "fingerprint_grid", study.fingerprint.grid);
  for (const auto& log : index.logs) fmt::print(out, "{:<22} {}\n", "log", log.string());
  for (const engine::UnusedBytes& unused : index.unused) {
    fmt::print(out, "{:<22} {}: {} bytes from byte {} on\n", "unused or in writing", unused.log.string(),
               unused.bytes, unused.from);
  }
}

}  // namespace

int status_command(const std::filesystem::path& file, std::ostream& out) {
  const bool is_there = std::filesystem::exists(file);
  const std::vector<std::filesystem::path> logs = engine::find_logs(file);
  if (is_there) print_file(file, out);
  std::vector<engine::LogHeader> studies;
  for (const auto& log : logs) {
    const auto study = engine::study_of_log(log);
    if (study && std::find(studies.begin(), studies.end(), *study) == studies.end())
      studies.push_back(*study);
  }
  if (!is_there && studies.empty())
    throw engine::IoError(file, "there is no such file, and no shard log beside it");
  for (const engine::LogHeader& study : studies) {
    fmt::print(out, "{}: {}\n", file.string(),
               is_there ? "a newer run is in progress or was stopped" : "unfinished");
    print_logs(logs, study, out);
  }
  return 0;
}

}  // namespace frahm::studies
