#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>

#include "studies/program/data_export.hpp"

namespace frahm::studies {

struct ExportOptions {
  std::filesystem::path file;
  std::filesystem::path output;  // "-": `out`; empty: the file's name with .csv
  std::string group = {};        // "resonance", "orbits", ...: its columns instead of the map; empty: the map
  bool csv = false;              // given as an option; the only form
  bool schedule = false;         // of a tuning: its schedule for a controller
  std::optional<double> step = {};    // of the schedule, in the unit of the band
  std::filesystem::path sweep = {};   // of a tuning: the study of a sweep at the optimum, written here
  std::filesystem::path run_up = {};  // of a tuning: the study of a run-up at the optimum, written here
  std::filesystem::path study = {};   // of an identification: the study of what it found, written here
  DataOptions data = {};              // simulated measurements; its output empty: none
};

// Writes a map as CSV: a row a point, coordinates first, then variables, numbers to 17 significant digits, an
// empty field (0 in flags) for a value not computed, points in the order of the map. Of a decay, transient or
// tuning, or if a group is asked for, the columns of the group side by side, the shorter ones filled with
// empty fields. Of a tuning also its schedule (schedule_table.hpp), or a study of its response at the optimum
// with the tables that it reads next to it (sweep_study.hpp); of an identification the study with its
// estimates (identified_study.hpp); of any study simulated measurements (data_export.hpp). Returns 0. Throws
// StudyError for anything the file does not have, results::StoreError, engine::IoError.
int export_command(const ExportOptions& options, std::ostream& out);

}  // namespace frahm::studies
