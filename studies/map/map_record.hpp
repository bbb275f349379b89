#pragma once

#include <string>
#include <vector>

#include "results/layout.hpp"
#include "results/map_writer.hpp"
#include "studies/map/assembly_options.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/map/tile_record.hpp"

// What a result file says of a map, and of how it came about (results/FORMAT.md).
namespace frahm::studies {

// How a result came about.
struct RunRecord {
  std::string command;  // "frahm run rig_atlas.toml"
  int threads = 0;      // of the last run, in all ranks
  int ranks = 1;        // of it
  std::string started;  // of the last run, ISO 8601 in UTC
};

// The time now: "2026-11-21T12:34:56Z".
std::string utc_now();

// Title, source and history of a file without a map.
results::MapLayout file_layout(const StudyPlan& plan, const RunRecord& run);

// The same with the axes in the user's units, coordinates and variables, without a point.
results::MapLayout map_layout(const MapPlan& plan, const RunRecord& run);

// The texts of /provenance. failed: lines "<point as --at takes it>: <reason>". missing: tiles that a partial
// file does not hold.
std::vector<results::Text> provenance(const StudyPlan& plan, const RunRecord& run,
                                      const std::vector<std::string>& failed, std::uint64_t missing = 0);

// The time histories of the points that the study lists, solved and written to /orbits; nothing if it lists
// none. An orbit that does not exist has a row without samples. Throws AssemblyStopped.
void write_orbits(const MapPlan& plan, const AssemblyOptions& options, results::MapWriter& writer);

// The group /borders, without a border. Returns its number, for MapWriter::append_ragged.
std::size_t create_borders(const MapPlan& plan, results::MapWriter& writer);

// The row of a border in it.  tile: the points among which it has its place.
std::vector<double> border_row(const Study& study, const MapBox& tile, const Border& border);

// Resonance and half-power frequencies of the masses that the study lists, solved for each point of the axes
// other than the frequency, a curve of /resonance each; nothing if it lists none. Throws AssemblyStopped.
void write_resonances(const MapPlan& plan, const AssemblyOptions& options, results::MapWriter& writer);

}  // namespace frahm::studies
