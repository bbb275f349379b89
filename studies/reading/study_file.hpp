#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/quantities/quantity.hpp"
#include "studies/reading/identify_choice.hpp"
#include "studies/reading/parameters.hpp"
#include "studies/reading/study_source.hpp"
#include "studies/reading/study_values.hpp"
#include "studies/reading/tune_choice.hpp"

namespace frahm::studies {

// A parameter that runs over values.
struct ParameterAxis {
  std::size_t parameter = 0;   // index in Parameters::list, of a number
  std::string unit;            // as the user wrote it, in a form UDUNITS reads; "" where none is known (SI)
  double si_factor = 1.0;      // SI value = si_factor x value
  std::vector<double> values;  // in `unit`
  std::vector<double> si_values;  // the same in SI
  std::string zip;                // axes of the same name advance together; "" alone
  Position position;              // of the [[axis]]
};

// One dimension of the map: an axis, or several that advance together.
struct GridDimension {
  std::string name;               // of the parameter, or of the zip
  std::vector<std::size_t> axes;  // indices in StudyFile::axes
  std::size_t size = 0;
};

// A number computed from the parameters of one dimension and kept beside them (the frequency ratio beside
// rpm).
struct DerivedCoordinate {
  std::string name, long_name;
  std::string unit = "1";  // of the number the expression gives; not converted
  StudyValue value;
  std::size_t dimension = 0;  // index in StudyFile::dimensions
};

struct OutputChoice {
  enum class Quantities { standard, all, listed };
  struct Name {
    std::string text;
    Position position;
  };

  Quantities quantities = Quantities::standard;
  std::vector<Name> names;  // of Quantities::listed, not empty then; the program knows which names exist
  bool single_precision = false;
  bool borders = false;                         // whether those between regimes are solved; exact law only
  std::vector<std::vector<Assignment>> orbits;  // points whose time histories are kept
  std::vector<std::size_t> resonances;          // masses whose resonance is sought along the frequency axis
};

// The same points again under another friction law, or with the cranks' motion cut at another order; beside
// the study's own.
struct Comparison {
  int taylor_order = 0;  // of every crank: 1, 2 or 4; 0: the law is what differs
  mechanics::FrictionLaw law = mechanics::FrictionLaw::exact;  // of every coulomb element
  StudyValue slope;                                            // of the arctan law
  std::vector<periodic::Quantity> quantities;                  // real-valued, at least one
};

enum class StudyKind { sweep, decay, transient, tune, identify };

// A mass's initial values [m], [m/s].
struct InitialValues {
  std::size_t mass = 0;  // index in Network::masses
  StudyValue displacement, velocity;
};

// [decay] or [transient], and [[initial]]. Of an identification the initial values alone.
struct MotionChoice {
  std::optional<StudyValue> duration;             // [s]
  int samples = 0;                                // of the history; 0: none
  std::optional<StudyValue> reference_frequency;  // of a decay: omega_h [rad/s]
  std::optional<StudyValue> sweep_to;             // of a run-up or run-down: the last frequency [rad/s]
  std::optional<StudyValue> sweep_rate;           // its angular acceleration, without sign [rad/s2]
  std::vector<InitialValues> initial;

  std::vector<const StudyValue*> values() const;
};

// A study, complete and checked: whatever stands here has a meaning for the solvers.
struct StudyFile {
  StudySource source;
  std::string title;  // "" if the study has none
  StudyKind kind = StudyKind::sweep;
  bool dimensionless = false;

  Parameters parameters;
  mechanics::Network network;
  StudyValues values;                      // of a decay: its frequency and excitation mean nothing
  MotionChoice motion;                     // of a decay, a transient or an identification
  std::optional<TuneChoice> tune;          // of a tuning
  std::optional<IdentifyChoice> identify;  // of an identification, which may have no network

  // Of a sweep; the other kinds have none of these.
  std::vector<ParameterAxis> axes;
  std::vector<GridDimension> dimensions;  // the first varies slowest; at least one
  std::vector<DerivedCoordinate> coordinates;
  OutputChoice output;
  std::vector<OutputChoice::Name> report_quantities;  // of the report's page; empty: its own choice
  std::optional<Comparison> comparison;

  // The dimension along which the excitation frequency changes, which runs innermost in the computation; if
  // there are several, the last one along which the masses and elements stay the same, else the last.
  std::optional<std::size_t> frequency_dimension;

  // Whether some mass or element changes along that dimension: its matrices are then rebuilt at each
  // frequency.
  bool values_depend_on_frequency = false;
};

// Reads and checks a study. Tables and measurements it names are read too, from paths relative to its own.
// Throws StudyError for anything wrong in it (`file:line:column: key: what was found, the rule, the nearest
// key`) and for a file that cannot be read.
StudyFile read_study(const std::filesystem::path& path);

// Whether the measurements of an identification, and earlier results that it takes, are read with it. Where
// they are left its records have no columns and nothing is fixed.
enum class DataFiles { read, leave };

// The same for a text at hand; name: stands for the file in messages, and its folder for that of the tables.
StudyFile parse_study(std::string text, const std::filesystem::path& name, DataFiles data = DataFiles::read);

std::string_view kind_name(StudyKind kind);  // as the study writes it
std::string_view kind_noun(StudyKind kind);  // as sentences say it: "a tuning"

// The study with some number parameters replaced, and checked again.
StudyFile with_parameters(StudyFile study, std::span<const Assignment> assignments);

// Puts the SI values of one index of a dimension into the parameters (Parameters::list order).
void place(const StudyFile& study, std::size_t dimension, std::size_t index, std::span<double> parameters);

// The values of a derived coordinate along its dimension.
std::vector<double> coordinate_values(const StudyFile& study, const DerivedCoordinate& coordinate);

// The dimensions along which what reads these parameters changes, ascending.
std::vector<std::size_t> dimensions_moving(const StudyFile& study, std::span<const std::size_t> reads);

// The unit in which a number parameter is spoken of (a bare number in an orbit, --at and --set; messages):
// that of its axis, band or bounds, else that of its definition, else "" for SI; and its factor to SI.
UsualUnit usual_unit(const StudyFile& study, std::size_t parameter);

// Refuses a point (SI values of all parameters; derived ones are recomputed) at which some value is not
// finite or out of its range. Throws StudyError: the value's place in the study, what it is and for which
// parameters, the rule.
void check_point(const StudyFile& study, std::span<double> parameters);

// Gives each crank the even orders that its crank/rod at a point needs, which may be more than on the grid.
void set_crank_orders_at(StudyFile& study, std::span<double> parameters);

}  // namespace frahm::studies
