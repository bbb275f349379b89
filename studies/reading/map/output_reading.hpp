#pragma once

#include <vector>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

// [output] and [report].
namespace frahm::studies {

// [output] of a sweep.
void read_output(const StudyContext& context, const TomlValue& root, Study& study);

// [report] of a study with a map.
void read_report(const StudyContext& context, const TomlValue& root, Study& study);

// The keys `quantities` and `precision` of [output], and the points listed under a key, `orbits` or
// `histories`.
void read_stored(const TomlSection& section, MapChoice& map);
void read_histories(const StudyContext& context, const TomlSection& section, const char* key, Study& study);
// The names in the array `quantities` of a section, and patterns of names (name_pattern.hpp), each once.
std::vector<OutputChoice::Name> read_quantity_names(const TomlSection& section);

}  // namespace frahm::studies
