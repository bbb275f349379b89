#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/orbits/orbits_wanted.hpp"
#include "solvers/quantities/quantity.hpp"
#include "studies/reading/parameters.hpp"
#include "studies/reading/profile.hpp"
#include "studies/reading/sample_choice.hpp"
#include "studies/reading/study_source.hpp"
#include "studies/reading/study_values.hpp"

// The options of a study of kind "sweep".
namespace frahm::studies {

// A parameter that runs over values.
struct ParameterAxis {
  std::size_t parameter = 0;   // index in Parameters::list, of a number
  std::string unit;            // as the user wrote it, in a form UDUNITS reads; "" where none is known (SI)
  double si_factor = 1.0;      // SI value = si_factor x value
  std::vector<double> values;  // in `unit`
  std::vector<double> si_values;    // the same in SI
  std::string zip;                  // axes of the same name advance together; "" alone
  Position position, zip_position;  // of the [[axis]] and its zip
};

// One dimension of the map: an axis, or several that advance together.
struct GridDimension {
  std::string name;               // of the parameter, or of the zip
  std::vector<std::size_t> axes;  // indices in SweepChoice::axes
  std::size_t size = 0;
};

// A number computed from the parameters of one dimension and recorded beside them (frequency ratio beside
// rpm).
struct DerivedCoordinate {
  std::string name, long_name;
  std::string unit = "1";  // of the number the expression gives; not converted
  StudyValue value;
  std::size_t dimension = 0;  // index in SweepChoice::dimensions
};

// Of the values in the file: doubles with the digits that their error bound supports, floats, or doubles with
// all digits.
enum class Precision { known_digits, single, full };
inline const std::vector<std::string> precision_names{"double", "single", "full"};

// Branches of responses along an axis, through rows of the map.
struct BranchChoice {
  std::size_t axis = 0;  // index in SweepChoice::axes; alone in its dimension
  std::vector<std::vector<Assignment>> at =
      {};  // the rows: those with the values of one of these; empty: all
};

// Whether a number is a value of an axis, but for the rounding of units.
bool is_on_axis(double value, double of_axis);
// The elements that may begin to stick, to stop or to touch: indices in Network::elements.
std::vector<std::size_t> elements_with_events(const mechanics::Network& network);

struct OutputChoice {
  enum class Quantities { standard, all, listed };
  struct Name {
    std::string text;
    Position position;
  };

  Quantities quantities = Quantities::standard;
  std::vector<Name> names;  // or patterns, of Quantities::listed, then not empty; not checked here
  Precision precision = Precision::known_digits;
  bool general_path = false;                    // every orbit by shooting, also where nothing sticks
  bool borders = false;                         // whether borders of regimes are solved; exact law only
  std::vector<std::vector<Assignment>> orbits;  // points whose time histories are recorded
  std::optional<BranchChoice> branches;         // exact law only
  std::vector<std::size_t> resonances;  // coordinates whose resonance is sought along the frequency axis
};

// A second response at the same points: another friction law, the cranks' motion cut at another order, or
// another of several responses.
struct Comparison {
  int taylor_order = 0;  // of every crank: 1, 2 or 4; 0: the law differs
  mechanics::FrictionLaw law = mechanics::FrictionLaw::exact;  // of every coulomb element
  StudyValue slope;                                            // of the arctan law
  std::optional<periodic::OrbitsWanted::Show> show;            // the law is then that of the study
  std::vector<periodic::Quantity> quantities;                  // real-valued, at least one
};

// The axes of a map and what is recorded of its points.
struct SweepChoice {
  std::vector<ParameterAxis> axes;
  std::vector<GridDimension> dimensions;  // the first varies slowest; at least one
  std::vector<DerivedCoordinate> coordinates;
  std::optional<SampleChoice> samples;  // of the dimension of samples, if there is one
  OutputChoice output;
  periodic::OrbitsWanted orbits;                      // of a system that may have several responses
  std::vector<OutputChoice::Name> report_quantities;  // of the report's page; empty: its default
  std::optional<OutputChoice::Name> headline;  // the quantity that summaries tell; else of headline_of()
  std::optional<Profile> profile;              // of the report's page
  std::optional<Comparison> comparison;

  // The dimension along which the excitation frequency changes, which runs innermost in the computation; if
  // there are several, the last one along which the masses and elements stay the same, else the last.
  std::optional<std::size_t> frequency_dimension;

  // Whether it, or what it is compared with, sweeps the frequency: each point of a row then follows from the
  // one before it.
  bool sweeps_frequency() const;

  // The values that are expressions of parameters.
  std::vector<const StudyValue*> values() const;
};

}  // namespace frahm::studies
