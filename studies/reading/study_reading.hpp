#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "studies/reading/study.hpp"
#include "studies/reading/toml_section.hpp"
#include "studies/reading/units.hpp"

// The parts of reading a study, in the order in which parse_study() calls them. Each throws StudyError.
namespace frahm::studies {

// What every part needs: where the text is, what units mean and whether units are allowed at all.
struct StudyContext {
  const StudySource& source;
  const UnitSystem& units;
  bool dimensionless = false;
};

// [parameters]. Numbers are still in their own unit: convert_parameters() comes after the network, which
// tells what they stand for. folder: of the tables.
Parameters read_parameters(const StudyContext& context, const TomlValue& root,
                           const std::filesystem::path& folder);
void convert_parameters(const StudyContext& context, Parameters& parameters);

struct NetworkOfStudy {
  mechanics::Network network;
  StudyValues values;
};

// [[mass]], [[element]] and, of a study that is not free of it, [excitation]. Notes in `parameters` what they
// stand for.
NetworkOfStudy read_network(const StudyContext& context, const TomlValue& root, Parameters& parameters,
                            StudyKind kind);

// [decay], [transient] and [[initial]] into the study's choice, after the network and as it does.
void read_motion(const StudyContext& context, const TomlValue& root, Study& study);

// [compare] into the choice of a sweep, once the network is there. Notes in the parameters what a slope is.
void read_comparison(const StudyContext& context, const TomlValue& root, Study& study);

// [tune], [[design]], [[constraint]], [[scenario]] and [[column]] into the study's choice, once units are
// converted.
void read_tuning(const StudyContext& context, const TomlValue& root, Study& study);

// Refuses what has no meaning at some corner of the bounds, of the scenarios and of the band, and gives each
// crank the even orders that it needs there.
void check_tuning(Study& study);

// [identify] and its tables into the study's choice. What they say in expressions comes before units are
// converted, as the network does; the measurements and the earlier estimates after. folder: of their files.
void read_identification(const StudyContext& context, const TomlValue& root, Study& study);
void read_measurements(const StudyContext& context, const TomlValue& root,
                       const std::filesystem::path& folder, DataFiles data, Study& study);

// Refuses what has no meaning in some record where the fit starts, and gives each crank the even orders that
// it needs there. Within the bounds there may be places without a meaning: a fit goes around them.
void check_identification(Study& study);

// Each corner of a box of some dimensions, as in which of them it lies at the upper end; of many dimensions
// not all of the corners, but all that differ from the lowest and the highest in one of them.
std::vector<std::vector<bool>> corners(std::size_t dimensions);

// What follows friction as it is has no use for its smoothed law.
void refuse_smooth_friction(const Study& study);

// Every mass must be held: by a chain of springs from ground or a node of prescribed motion.
// masses: their positions in the study.
void check_masses_are_held(const StudyContext& context, const NetworkOfStudy& system,
                           const std::vector<Position>& masses);

// [[axis]], [[coordinate]], [output] and [report] into the choice of a sweep.
void read_axes(const StudyContext& context, const TomlValue& root, Study& study);
void read_coordinates(const StudyContext& context, const TomlValue& root, Study& study);
void read_output(const StudyContext& context, const TomlValue& root, Study& study);
void read_report(const StudyContext& context, const TomlValue& root, Study& study);

// The names in the array `quantities` of a section, each once.
std::vector<OutputChoice::Name> read_quantity_names(const TomlSection& section);

// Every value must be finite and within its range wherever the grid goes and at the orbits kept. A value is
// tried on all points of the dimensions it depends on, or, where these are too many, on their corners.
void check_grid(const Study& study);

// How many even orders each crank needs for its largest crank/rod on the grid and at the orbits kept.
void set_crank_orders(Study& study);
// Adds those that it needs at a point more (SI values of all parameters, completed).
void add_crank_orders_at(Study& study, std::span<const double> parameters);

// A number in the unit given beside it, as { value, unit } or as a bare number (no unit then).
struct NumberWithUnit {
  double value = 0.0;
  std::optional<Unit> unit;  // none in a dimensionless study
  Position unit_position;
};
NumberWithUnit read_number_with_unit(const StudyContext& context, const std::string& where,
                                     const TomlValue& value);

// A number parameter set to a value: an entry of a table such as { omega = 250, I = { value = 6, unit = "kg"
// } }, a bare number in the unit in which the study speaks of it. why_not: why a parameter cannot be set
// there, "" if it can; empty: any can.
using WhyNot = std::function<std::string(std::size_t parameter)>;
Assignment read_assignment(const StudyContext& context, const Study& study, const std::string& where,
                           const TomlEntry& entry, const WhyNot& why_not = {});

// The unit of a key; none in a dimensionless study, where only "1" is allowed.
std::optional<Unit> read_unit(const StudyContext& context, const std::string& where, const TomlValue& value);

// An expression of the parameters.
Expression read_expression(const StudyContext& context, const Parameters& parameters,
                           const std::string& where, const TomlValue& value);

}  // namespace frahm::studies
