#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/sample_choice.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/text/study_source.hpp"

// The points of a map and what is recorded of them: of a study of kind "sweep", and of one of kind
// "transient" with axes.
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

// One dimension of the map: an axis, or several that advance together; the records have one of their own.
struct GridDimension {
  std::string name;               // of the parameter, or of the zip; "record"
  std::vector<std::size_t> axes;  // indices in MapChoice::axes; none of the records
  std::size_t size = 0;
};

// A number computed from the parameters of one dimension and recorded next to them (frequency ratio next to
// rpm).
struct DerivedCoordinate {
  std::string name, long_name;
  std::string unit = "1";  // of the number in the file
  double si_factor = 1.0;  // the expression gives si_factor x that number: factor_of_label()
  StudyValue value;
  std::size_t dimension = 0;  // index in MapChoice::dimensions
};

// Form of the values in the file: doubles with the digits that their error bound supports, floats, or doubles
// with all digits.
enum class Precision { known_digits, single, full };

// The records that drive the motions of a map, one after the other.
struct RecordAxis {
  std::vector<std::string> names;  // of each
  std::size_t dimension = 0;       // index in MapChoice::dimensions
  Position position;               // of the [[axis]]
};

// A point whose time history is recorded; what it leaves out has its value in [parameters].
struct KeptPoint {
  std::vector<Assignment> at;
  std::size_t record = 0;  // of those of the axis, if there is one
};

struct OutputChoice {
  enum class Quantities { standard, all, listed };
  struct Name {
    std::string text;
    Position position;
  };

  Quantities quantities = Quantities::standard;
  std::vector<Name> names;  // or patterns, of Quantities::listed, then not empty; not checked here
  Precision precision = Precision::known_digits;
  std::vector<KeptPoint> histories;
};

// The axes of a map and what is recorded of its points.
struct MapChoice {
  std::vector<ParameterAxis> axes;
  std::vector<GridDimension> dimensions;  // the first varies slowest; at least one
  std::optional<RecordAxis> records;
  std::optional<SampleChoice> samples;  // of the dimension of samples, if there is one
  std::vector<DerivedCoordinate> coordinates;
  OutputChoice output;
  std::vector<OutputChoice::Name> report_quantities;  // of the report's page; empty: its default
  std::optional<OutputChoice::Name> headline;  // the quantity that summaries show; otherwise of headline_of()
};

}  // namespace frahm::studies
