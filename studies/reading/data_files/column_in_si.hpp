#pragma once

#include <string>
#include <vector>

#include "studies/reading/data_files/record_columns.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

// Columns of measurements in SI, by the unit that their file or the study gives them.
namespace frahm::studies {

// The unit that the study gives a column.
struct GivenUnit {
  const TomlValue* unit = nullptr;  // null: it gives none
  std::string place{};              // in its section: `units: displacement`; empty: the key `unit`
};

// A file of measurements that a section of the study names at a position.
struct NamedFile {
  const TomlSection& section;
  Position position;
};

// The values of a column in SI, where without any unit they are. Throws StudyError for a unit that does not
// exist or has another dimension than the column's role, for two different ones, and for values out of the
// role's range or order.
std::vector<double> in_si(const StudyContext& context, const NamedFile& file, const RawRecord& raw,
                          const RawColumn& column, const GivenUnit& given);

}  // namespace frahm::studies
