#pragma once

#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// The document with every table of a list, such as [[mass]], that has  repeat = { i = [1, 60] }  written out:
// one table for each i from 1 to 60, in whose texts and keys {i}, {i+2} and {i-1} are these numbers;
// where a key takes a plain number, as order = "{i}" does, the text is that number.
// [3, 60, 3] goes by steps of 3. Of several indices all combinations, the last one fastest. Positions stay
// those of the text.
// Throws StudyError for a range that is none, an index that is unknown, and more than 10,000 tables.
TomlValue with_repetitions(const StudySource& source, TomlValue document);

}  // namespace frahm::studies
