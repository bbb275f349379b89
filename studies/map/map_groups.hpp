#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "results/layout.hpp"
#include "results/map_writer.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/map/tile_entry.hpp"
#include "studies/provenance/assembly_options.hpp"
#include "studies/provenance/provenance.hpp"

// The record of a map in a result file (results/FORMAT.md).
namespace frahm::studies {

// The layout of a map's file, without points: what every file says, the axes in the user's units, coordinates
// and variables.
results::MapLayout map_layout(const MapPlan& plan, const RunFacts& run);

// How a quantity is recorded.
results::Variable variable_of(const Study& study, const periodic::QuantityDescription& description);

// A parameter of the study, as a coordinate of points or rows.
results::Variable parameter_variable(const Study& study, std::size_t parameter, const std::string& unit);

// The time histories of the points that the study lists, solved and written to /orbits; nothing if it lists
// none. An orbit that does not exist has a row without samples. Throws AssemblyStopped.
void write_orbits(const MapPlan& plan, const AssemblyOptions& options, results::MapWriter& writer);

// What they take: the time is that of one of them, times their number; the size is before compression.
struct OrbitsCost {
  double seconds = 0.0, bytes = 0.0;
};
OrbitsCost cost_of_orbits(const MapPlan& plan);

// The same for the motions that a study of motions lists, in /histories. A motion that failed has a row
// without samples.
void write_histories(const MapPlan& plan, const AssemblyOptions& options, results::MapWriter& writer);

// What distinguishes the points whose histories are kept: the parameters on axes, and the record of an axis
// of records. Names and units; and the numbers at SI values of all parameters.
std::vector<results::Variable> row_variables(const Study& study);
std::vector<double> row_values(const Study& study, std::span<const double> parameters, std::size_t record);

// Creates the group /borders, empty. Returns its number, for MapWriter::append_ragged.
std::size_t create_borders(const MapPlan& plan, results::MapWriter& writer);

// The row of a border in that group.  tile: the tile of the border.
std::vector<double> border_row(const Study& study, const MapBox& tile, const Border& border);

// Resonance and half-power frequencies of the masses and signals that the study lists, solved for each point
// of the axes other than the frequency, a curve of /resonance each; nothing if it lists none. Throws
// AssemblyStopped.
void write_resonances(const MapPlan& plan, const AssemblyOptions& options, results::MapWriter& writer);

}  // namespace frahm::studies
