#pragma once

#include <optional>
#include <string>
#include <vector>

#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/text/study_source.hpp"

// What all parts of reading a study share. Each part throws StudyError.
namespace frahm::studies {

// The dimension that the value of an expression has to have: that of a unit, and a sentence that says so.
struct WantedDimension {
  Unit unit;
  std::string sentence;  // "a stiffness (N/m) is expected"
};

// An expression of the study outside [parameters].
struct WrittenExpression {
  Expression expression;
  std::string where;
  Position position;
  std::optional<WantedDimension> wanted;  // nothing: any dimension will do
};

// Shared by all parts: the text, the unit system, whether units are allowed at all, the expressions read so
// far, and whether mistakes were left out of the study: then nothing is said of the system as a whole.
struct StudyContext {
  const StudySource& source;
  const UnitSystem& units;
  bool dimensionless = false;
  std::vector<WrittenExpression>& written;
  bool is_whole = true;
};

}  // namespace frahm::studies
